"""A policy outside of the simulator: above, down, close, up, across, down, open, up.

``python policy.py`` answers on standard output, ``python policy.py 9000`` on a WebSocket. It needs msgpack, and for the
latter websockets, but not RobBDD. All coordinates are in the world frame, in m and rad.
"""

# The messages are maps of any content, and msgpack has no types.
# pyright: basic

import os
import sys
from math import atan2, ceil, dist

import msgpack

TRAVEL = 0.35
"""Height at which objects are carried."""
PACE = 0.004
"""Largest step of the tool per tick."""

CLOSE = 0.003
"""Distance at which the tool has arrived."""
ARRIVES = 100
"""Ticks within which the arm catches up with its target."""


class Policy:
    """One behaviour of one agent. Everything that it remembers begins with a reset."""

    def reset(self, message):
        """Begin a behaviour."""
        if message["behaviour"] != "pick-place":
            return {"type": "failed", "reason": f"this policy does not know how to {message['behaviour']}"}
        arguments = message["arguments"]
        place = arguments["workspace"]
        # For a set of workspaces, use the first one.
        self.commands = self.carry(arguments["object"], place if isinstance(place, str) else place[0])
        self.seen = {}
        return {"type": "ready", "version": 1}

    def observation(self, message):
        """Return the command for one tick."""
        self.seen = message
        return next(self.commands, {"type": "command", "done": True})

    def carry(self, name, workspace):
        """Yield the commands of one behaviour, one for each observation."""
        cube = self.seen["objects"][name]
        x, y, z = cube["position"]
        closing = across(cube["rotation"])
        yield from self.move((x, y, TRAVEL), closing, 1.0, ["pick-start"])
        yield from self.move((x, y, z), closing, 1.0)
        yield from self.wait((x, y, z), closing, 0.0)
        if name not in self.seen["holds"]:
            yield {"type": "failed", "reason": f"the fingers closed beside {name}"}
        yield from self.move((x, y, TRAVEL), closing, 0.0)
        x, y, z = self.seen["places"][workspace]
        above, inside = (x, y, TRAVEL), (x, y, z + 0.05)
        yield from self.move(above, 0.0, 0.0, ["pick-end", "place-start"])
        yield from self.move(inside, 0.0, 0.0)
        yield from self.wait(inside, 0.0, 1.0)
        yield from self.move(above, 0.0, 1.0)
        yield {"type": "command", "events": ["place-end"], "done": True}

    def move(self, goal, closing, opening, events=()):
        """Move the tool evenly to a position."""
        start = self.seen["tool"]["position"]
        count = max(1, ceil(dist(start, goal) / PACE))
        for number in range(1, count + 1):
            place = [a + (b - a) * number / count for a, b in zip(start, goal, strict=True)]
            yield command(place, closing, opening, events if number == 1 else ())
        for _ in range(ARRIVES):
            if dist(self.seen["tool"]["position"], goal) < CLOSE:
                break
            yield command(goal, closing, opening)

    def wait(self, place, closing, opening):
        """Open or close the fingers, and wait until they hold."""
        for _ in range(70):
            yield command(place, closing, opening)


def command(place, closing, opening, events=()):
    """Return a command: a position of the tool, which points down."""
    tool = {"position": list(place), "closing": closing}
    return {"type": "command", "tool": tool, "opening": opening, "events": list(events)}


def across(rotation):
    """Return a direction across a cube: that of its most horizontal axis."""
    flattest = min(range(3), key=lambda axis: abs(rotation[2][axis]))
    return atan2(rotation[1][flattest], rotation[0][flattest])


def answer(policy, message):
    """Return the answer to a message: its type is the name of a method."""
    return policy.reset(message) if message["type"] == "reset" else policy.observation(message)


def on_standard_streams():
    """Answer messages until standard input is closed."""
    policy = Policy()
    messages = msgpack.Unpacker()
    while received := os.read(sys.stdin.fileno(), 65536):
        messages.feed(received)
        for message in messages:
            sys.stdout.buffer.write(msgpack.packb(answer(policy, message)) or b"")
            sys.stdout.buffer.flush()


def on_port(port):
    """Answer messages of WebSockets; each connection has a policy of its own."""
    from websockets.sync.server import serve

    def connected(socket):
        policy = Policy()
        for frame in socket:
            socket.send(msgpack.packb(answer(policy, msgpack.unpackb(frame))))

    with serve(connected, "0.0.0.0", port) as server:
        server.serve_forever()


if __name__ == "__main__":
    on_port(int(sys.argv[1])) if sys.argv[1:] else on_standard_streams()
