"""One Snakemake at a time works in a folder: a lock of the kernel, which needs no unlocking after a kill.

Snakemake's own lock is a file that a killed Snakemake leaves behind, and nobody can tell it from that of a living
one. So tools/workflow/run switches it off (`--nolock`) and the Snakefile takes this one.
"""

import fcntl
import os
import sys
from pathlib import Path


def hold(file: str) -> int:
    """Takes the lock until the process ends; ends it with a line where another process has the lock. Children do not
    inherit it: runs that survive a killed Snakemake do not keep the next one out."""
    descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        holder = Path(file).read_text(encoding="utf-8").strip() or "another process"
        print(f"tools/workflow: {Path.cwd().parent}: is held by {holder}, which runs Snakemake", file=sys.stderr)
        os._exit(2)  # Snakemake would add a traceback to an exception
    except OSError as fault:
        print(f"tools/workflow: {Path.cwd()}: no lock keeps others out: {fault.strerror}", file=sys.stderr)
    os.ftruncate(descriptor, 0)
    os.write(descriptor, f"process {os.getpid()} on host {os.uname().nodename}\n".encode())
    return descriptor
