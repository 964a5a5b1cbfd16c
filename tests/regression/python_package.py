"""The package voussoir for the tests of Python. Where the module was not built, the test that imports this ends as
skipped."""

import sys

try:
    import voussoir
    import voussoir.engine

    voussoir.engine.core()
except ImportError as fault:
    if "compiled module is missing" not in str(fault) and getattr(fault, "name", "") != "voussoir":
        raise
    print(f"skipped: {fault}")
    sys.exit(77)

__all__ = ["voussoir"]
