"""What the language can talk about: one file per predicate, behaviour, robot, object and simulator."""
