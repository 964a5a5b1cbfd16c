"""What generate() leaves beside its file until it is done: one part an increment, and a checkpoint of the grains.

A process that is killed while it writes an HDF5 file can leave a file that nobody can read. Parts are therefore files
of their own, which are written under another name and then renamed; nothing that exists is ever written to again."""

import fcntl
import hashlib
import json
import os
import shutil
import time
import zipfile
from pathlib import Path
from typing import IO, Any

import numpy as np

Arrays = dict[str, np.ndarray]
PATIENCE = 2.0  # with a process that holds a folder [s]


class Parts:
    """The folder FILE.parts of an unfinished dataset. The process that holds it has it locked.

    RuntimeError: another process makes this dataset. FileExistsError: the folder belongs to another dataset, or to one
    that must not be resumed."""

    def __init__(self, file: Path, plan: dict[str, Any], resume: bool) -> None:
        self.folder = file.with_name(file.name + ".parts")
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = self._locked()
        self._unsettled: list[Path] = []  # written, and perhaps not on the disk yet
        known = self.folder / "plan.json"
        if known.exists() and not resume:
            self._empty()
        if not known.exists():
            self._empty()
            write(known, json.dumps(plan, indent=1).encode())
        elif json.loads(known.read_text()) != plan:
            self._lock.close()
            other = _difference(json.loads(known.read_text()), plan)
            raise FileExistsError(
                f"{self.folder} has the beginning of another dataset ({other}); resume=False removes it and begins anew"
            )

    def save(self, name: str, arrays: Arrays) -> None:
        """Writes arrays under a name, or not at all. A process that dies loses nothing of them; only after `settle` the
        machine may lose its power as well."""
        temporary, path = self.folder / f"{name}.new", self.folder / f"{name}.npz"
        with temporary.open("wb") as stream:
            np.savez(stream, **arrays)  # type: ignore[arg-type]  # arrays by name, none of which is called allow_pickle
        temporary.rename(path)
        self._unsettled.append(path)

    def settle(self) -> None:
        """Waits until everything that was saved is on the disk, which takes some ten milliseconds a file."""
        for path in self._unsettled:
            if path.exists():
                with path.open("rb") as stream:
                    os.fsync(stream.fileno())
        self._unsettled.clear()

    def load(self, name: str) -> Arrays | None:
        """Arrays of a name; None: there are none. RuntimeError: their file is damaged, as the loss of power can leave
        it."""
        path = self.folder / f"{name}.npz"
        if not path.exists():
            return None
        try:
            with np.load(path) as arrays:
                return {key: arrays[key] for key in arrays.files}
        except (OSError, EOFError, ValueError, zipfile.BadZipFile) as error:
            raise RuntimeError(f"{path} is damaged ({error}); resume=False begins anew") from error

    def has(self, name: str) -> bool:
        return (self.folder / f"{name}.npz").exists()

    def remove(self, name: str) -> None:
        (self.folder / f"{name}.npz").unlink(missing_ok=True)

    def leave(self) -> None:
        """Unlocks the folder, whose parts stay."""
        self._lock.close()

    def discard(self) -> None:
        """Removes the folder."""
        shutil.rmtree(self.folder)
        self._lock.close()

    def _locked(self) -> IO[bytes]:
        """The locked file. A process that was killed a moment ago may still hold it."""
        lock, patience = (self.folder / "lock").open("wb"), time.monotonic() + PATIENCE
        while True:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                if time.monotonic() > patience:
                    lock.close()
                    raise RuntimeError(f"another process makes the dataset of {self.folder}") from None
                time.sleep(0.05)
            else:
                return lock

    def _empty(self) -> None:
        for entry in self.folder.iterdir():
            if entry.name != "lock":
                entry.unlink()


def write(path: Path, data: bytes) -> None:
    """Writes a file under another name, and renames it when its bytes are on the disk."""
    temporary = path.with_name(path.name + ".new")
    with temporary.open("wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())
    temporary.rename(path)


def digest(*arrays: Any) -> str:
    """A fingerprint of arrays and texts."""
    total = hashlib.sha256()
    for array in arrays:
        data = np.ascontiguousarray(array)
        total.update(f"{data.dtype.str}{data.shape}".encode())
        total.update(data.tobytes() if data.dtype.kind != "U" else "\0".join(data.ravel().tolist()).encode())
    return total.hexdigest()[:16]


def _difference(known: dict[str, Any], plan: dict[str, Any]) -> str:
    names = [name for name in {**known, **plan} if known.get(name) != plan.get(name)]
    return "it differs in " + ", ".join(names)
