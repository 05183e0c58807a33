"""The words of the language: one file per predicate, behaviour, robot and object model."""
