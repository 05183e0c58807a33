"""What can go wrong in a scenario's world; each message is for the user to read as it is."""


class SceneError(Exception):
    """The scene cannot be built; the message says what is wrong with it and what to change."""


class BehaviourError(Exception):
    """The agent cannot go on with its behaviour; the message says why, with the time where one is known."""


class UserError(Exception):
    """The user's own code is broken; the message names its file and line. Nothing can be concluded from the run."""


class SimulationError(Exception):
    """The simulation itself broke down."""
