"""The base class of the errors that users of the package can catch."""


class RobbddError(Exception):
    """The request cannot be carried out; the message states the reason and, where known, the fix."""
