"""Stands for a Python interpreter: ``launch.py SOCKET CODE [ARGUMENT...]`` runs code of ours in a fork of the server.

The fork gets this process's standard streams, working directory, environment and umask. SIGINT, SIGTERM and SIGHUP are
forwarded, exit code or signal returned; when this process dies, the fork is killed.
"""

import json
import os
import select
import signal
import socket
import struct
import sys
from types import FrameType

LENGTH = struct.Struct("!I")
STATUS = struct.Struct("!i")
FORWARDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def main() -> None:
    address, *arguments = sys.argv[1:]
    umask = os.umask(0)
    os.umask(umask)
    data = json.dumps({"arguments": arguments, "environment": dict(os.environ), "umask": umask}).encode()
    folder = os.open(".", os.O_RDONLY)
    connection = socket.socket(socket.AF_UNIX)
    connection.connect(address)

    def forward(number: int, _: FrameType | None) -> None:
        try:
            connection.send(bytes([number]))
        except OSError:  # the fork has ended: a terminal hangs up when its last user closes it
            return

    for number in FORWARDED:
        signal.signal(number, forward)
    socket.send_fds(connection, [LENGTH.pack(len(data))], [0, 1, 2, folder])
    connection.sendall(data)
    # The fork alone holds the streams: who reads them sees when it closes them.
    for descriptor in (0, 1, 2):
        os.close(descriptor)
    # A signal that comes just before the call is handled after it: wait in turns.
    while not select.select([connection], [], [], 1.0)[0]:
        pass
    answer = connection.recv(STATUS.size, socket.MSG_WAITALL)
    status = STATUS.unpack(answer)[0] if len(answer) == STATUS.size else 1
    if status < 0:
        for number in FORWARDED:
            signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), -status)
    os._exit(status)


if __name__ == "__main__":
    main()
