"""One Snakemake at a time works in a folder: a lock of the kernel, which needs no unlocking after a kill.

Snakemake's own lock is a file that a killed Snakemake leaves behind, and nobody can tell it from that of a living
one. So tools/workflow/run switches it off (`--nolock`) and the Snakefile takes this one.
"""

import fcntl
import os
import sys
from pathlib import Path


def holder_of(file: Path) -> str | None:
    """Who has the lock, as text; None where nobody has it."""
    try:
        with file.open(encoding="utf-8") as opened:
            fcntl.flock(opened, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return file.read_text(encoding="utf-8").strip() or "another process"
    except OSError:  # no such file, or no locks on this file system
        return None
    return None


def refusal(folder: Path, holder: str) -> str:
    return f"tools/workflow: {folder}: is held by {holder}, which runs Snakemake"


def hold(file: str) -> int:
    """Takes the lock until the process ends; ends it with a line where another process has the lock. Children do not
    inherit it: runs that survive a killed Snakemake do not keep the next one out."""
    descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print(refusal(Path.cwd().parent, holder_of(Path(file)) or "another process"), file=sys.stderr)
        os._exit(2)  # Snakemake would add a traceback to an exception
    except OSError as fault:
        print(f"tools/workflow: {Path.cwd()}: no lock keeps others out: {fault.strerror}", file=sys.stderr)
    os.ftruncate(descriptor, 0)
    os.write(descriptor, f"process {os.getpid()} on host {os.uname().nodename}\n".encode())
    return descriptor
