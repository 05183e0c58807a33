"""Stores the members of a wheel without compression: it is then compressed as one text, which is much smaller."""

import sys
from io import BytesIO
from pathlib import Path
from zipfile import ZIP_STORED, ZipFile


def stored(wheel: bytes) -> bytes:
    """The same wheel, in the same order and with the same dates, its members uncompressed."""
    out = BytesIO()
    with ZipFile(BytesIO(wheel)) as packed, ZipFile(out, "w") as unpacked:
        for member in packed.infolist():
            content = packed.read(member)
            member.compress_type = ZIP_STORED
            unpacked.writestr(member, content)
    return out.getvalue()


if __name__ == "__main__":
    file = Path(sys.argv[1])
    file.write_bytes(stored(file.read_bytes()))
