"""The iteration number that denotes the last occurrence of an event.

It is separate from traces, so that an editor need not load numpy.
"""

LAST = -1
"""The last iteration, whose number is unknown because a behaviour tree may execute a node again."""
