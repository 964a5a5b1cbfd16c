"""The life of the engine: one start a process, an end at the interpreter's exit."""

import atexit
import threading
from types import ModuleType

_guard = threading.Lock()
_is_first = True


def core() -> ModuleType:
    """The compiled module. ImportError says how to get it where it is missing."""
    try:
        from voussoir import _core
    except ImportError as fault:
        raise ImportError(
            "voussoir's compiled module is missing, or was built for another Python. `pip install .` in a checkout "
            f"builds it, and so does the CMake target _core ({fault})"
        ) from fault
    return _core


def initialize(threads: int = 0) -> None:
    """Starts the engine with this number of threads. It happens by itself at the first use. The number becomes that of
    OpenMP in the calling thread, too, for whatever else uses the system's libgomp.

    Args:
        threads: wanted number; 0 takes KOKKOS_NUM_THREADS, or OMP_NUM_THREADS, or one for each core

    Raises:
        RuntimeError: the engine runs with another number already, or was started before fork()
        ValueError: the number is negative
    """
    global _is_first  # noqa: PLW0603
    if threads < 0:
        raise ValueError(f"threads must not be negative, is {threads}")
    engine = core()
    with _guard:
        engine.initialize(threads)
        if _is_first:
            atexit.register(engine.finish)
            _is_first = False


def running() -> ModuleType:
    """The compiled module with its engine started."""
    engine = core()
    if not engine.is_initialized():
        initialize()
    return engine


def threads() -> int:
    """The number of threads of the engine, which this call starts where it does not run yet."""
    return int(running().threads())
