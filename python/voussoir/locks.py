"""Whether a process computes the results of a folder: run.lock (docs/reference/files.md)."""

import os
import re
import socket
from pathlib import Path


def is_running(folder: Path) -> bool:
    """True where run.lock names a process that runs. Of a process on another host only the file tells, which a killed
    run leaves behind."""
    try:
        text = (folder / "run.lock").read_text(errors="replace")
    except OSError:
        return False
    told = dict(re.findall(r"^(host|process|born) (\S+)$", text, re.MULTILINE))
    if "process" not in told:
        return False
    if told.get("host") != socket.gethostname():
        return True
    return runs(int(told["process"]), int(told.get("born", 0)))


def runs(process: int, born: int) -> bool:
    """True where a process of this number runs that began at this tick of the machine (0: not known)."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    try:
        told = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return True
    return told[0] != "Z" and born in (0, int(told[19]))  # the state, and the 22nd field of the line
