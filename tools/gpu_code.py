#!/usr/bin/env python3
"""Names the code for devices that a CUDA library holds: machine code (sm_80) and PTX (compute_90).

    tools/gpu_code.py FILE

The layout of the fat binaries in which it stands is not documented; it is that of CUDA 11 to 13: a header of 16 bytes,
then entries of kind, size of the entry's header, size of its code and, 28 bytes from its start, the architecture.
"""

import struct
import sys
from pathlib import Path

MAGIC = struct.pack("<I", 0xBA55ED50)
KINDS = {1: "compute", 2: "sm"}


def code_of(data: bytes) -> set[str]:
    """Names of all entries of all fat binaries in the bytes of a file."""
    found = set()
    at = data.find(MAGIC)
    while at >= 0:
        header, size = struct.unpack_from("<HQ", data, at + 6)
        entry, end = at + header, at + header + size
        while entry < min(end, len(data) - 32):
            kind, _, entry_header, entry_size = struct.unpack_from("<HHIQ", data, entry)
            (architecture,) = struct.unpack_from("<I", data, entry + 28)
            if kind not in KINDS or entry_header == 0:
                break
            found.add(f"{KINDS[kind]}_{architecture}")
            entry += entry_header + entry_size
        at = data.find(MAGIC, at + 4)
    return found


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print(" ".join(sorted(code_of(Path(sys.argv[1]).read_bytes()))))
