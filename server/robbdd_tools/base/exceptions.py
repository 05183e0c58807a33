"""The base class of the errors that users of the package can catch."""


class RobbddError(Exception):
    """The request cannot be carried out. The message states the reason and, if it is known, the fix."""
