"""Runs the Micro Manager and a macro side in two threads of one process, since the stand-in couples no others:

couple.py micro-manager-config.json macro.py
"""

import runpy
import sys
import threading

from micro_manager import MicroManagerCoupling


def micro(configuration):
    manager = MicroManagerCoupling(configuration, log_file="micro-manager.log")
    manager.initialize()
    manager.solve()


if __name__ == "__main__":
    sys.path.insert(0, "")
    thread = threading.Thread(target=micro, args=(sys.argv[1],), daemon=True)
    thread.start()
    runpy.run_path(sys.argv[2], run_name="__main__")
    thread.join()
