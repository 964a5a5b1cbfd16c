"""What programs do to a Python module, each in a process of its own: threads, signals, fork, exceptions in handlers,
another OpenMP runtime, the interpreter's end. Each of them works or raises an exception; none aborts, hangs or loses a
committed state. And what the module links and shows to others. Arguments name some of the abuses."""

import importlib.util
import subprocess
import sys
import textwrap
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from program import check
from python_package import voussoir

BEGIN = """
import os, signal, threading, time
import numpy as np
import voussoir
def batch(n=16, **more):
    return voussoir.RveBatch(voussoir.make_packings(grains=40), n, **more)
def strain(n, yy=-1e-3):
    f = np.zeros((n, 2, 2)); f[:, 1, 1] = yy
    return f
def refusal(work):
    try:
        work()
    except RuntimeError as error:
        return str(error)
    return "no error"
def stopped(work, after=0.4):  # the time from Ctrl-C to KeyboardInterrupt [s]
    sent = []
    def send():
        sent.append(time.monotonic()); os.kill(os.getpid(), signal.SIGINT)
    threading.Timer(after, send).start()
    try:
        work()
    except KeyboardInterrupt:
        return time.monotonic() - sent[0]
    return "not stopped"
"""

# name -> (program, what it prints at the end)
ABUSES = {
    "the interpreter ends while a batch is open": ("b = batch(); b.evaluate(strain(16)); print('end')", "end"),
    "the interpreter ends within an exception": (
        "b = batch()\ntry:\n  raise SystemExit(3)\nfinally:\n  b.evaluate(strain(16)); print('end')",
        "end",
    ),
    "a daemon thread evaluates when the interpreter ends": (
        """
        b = batch(4096, preset="reference")
        threading.Thread(target=lambda: refusal(lambda: b.evaluate(strain(4096))), daemon=True).start()
        time.sleep(0.3); print("end")
        """,
        "end",
    ),
    "two starts": ("voussoir.initialize(); voussoir.initialize(voussoir.threads()); print(batch())", "16 points"),
    "a second start with another number of threads": (
        "n = voussoir.threads(); print(refusal(lambda: voussoir.initialize(n + 1)))",
        "cannot change to",
    ),
    "fork() after the first use": (
        """
        b = batch()
        pid = os.fork()
        if pid == 0:
            work = [b.commit, b.fields, voussoir.threads, voussoir.initialize, lambda: batch(),
                    lambda: b.evaluate(strain(16)), lambda: voussoir.make_packings(grains=40)]
            told = [refusal(one) for one in work]
            b.close()
            print("child:", all("spawn" in one for one in told) or told, flush=True)
            raise SystemExit(0)
        status = os.waitpid(pid, 0)[1]
        print("status", status, b.evaluate(strain(16)).usable)
        """,
        "child: True\nstatus 0 True",
    ),
    "fork() before the first use": (
        """
        pid = os.fork()
        ok = batch().evaluate(strain(16)).usable
        if pid: print(ok, os.waitpid(pid, 0)[1])
        """,
        "True 0",
    ),
    "four threads, one batch": (
        """
        b = batch(); f = strain(16); one = b.evaluate(f).stress; out = []
        threads = [threading.Thread(target=lambda: out.append((b.evaluate(f).stress == one).all())) for _ in range(4)]
        [t.start() for t in threads]; [t.join() for t in threads]
        print(all(out), len(out))
        """,
        "True 4",
    ),
    "four threads, a batch each": (
        """
        one = batch().evaluate(strain(16)).stress; out = []
        threads = [threading.Thread(target=lambda: out.append((batch().evaluate(strain(16)).stress == one).all()))
                   for _ in range(4)]
        [t.start() for t in threads]; [t.join() for t in threads]
        print(all(out), len(out))
        """,
        "True 4",
    ),
    "other Python threads run meanwhile": (
        """
        b = batch(1024); ticks = []
        def tick():
            while not ticks or ticks[-1] >= 0: ticks.append(len(ticks)); time.sleep(0.001)
        thread = threading.Thread(target=tick); thread.start()
        b.evaluate(strain(1024)); print(len(ticks) > 5); ticks.append(-1); thread.join()
        """,
        "True",
    ),
    "the first use in another thread": (
        """
        r = []
        thread = threading.Thread(target=lambda: r.append(batch().evaluate(strain(16)).usable))
        thread.start(); thread.join(); print(r, batch().evaluate(strain(16)).usable)
        """,
        "[True] True",
    ),
    "Ctrl-C in an evaluation": (
        """
        b = batch(8192, preset="reference"); before = b.state()
        print(stopped(lambda: [b.evaluate(strain(8192)) for _ in range(20)]) < 1.5, refusal(b.commit))
        print(b.state() == before, b.evaluate(strain(8192, 1e-7), tangent=False).usable)
        """,
        "True the last evaluation was refused or interrupted and cannot be committed\nTrue True",
    ),
    "Ctrl-C in the evaluation of one large RVE": (
        """
        one = voussoir.RveBatch(voussoir.make_packings(grains=700), 1, preset="reference", precision="double")
        print(stopped(lambda: one.evaluate(strain(1, -0.2)), 1.0) < 4)
        """,
        "True",
    ),
    "Ctrl-C while another thread uses the batch": (
        """
        b = batch(8192, preset="reference")
        other = threading.Thread(target=lambda: refusal(lambda: [b.evaluate(strain(8192)) for _ in range(9)]))
        other.daemon = True; other.start(); time.sleep(0.2)
        print(stopped(lambda: [b.evaluate(strain(8192)) for _ in range(9)]) < 4)
        """,
        "True",
    ),
    "a signal's handler that forks": (
        """
        b = batch(8192, preset="reference"); parent = os.getpid(); children = []
        def handler(*_):
            pid = os.fork()
            if pid: children.append(pid)
        signal.signal(signal.SIGALRM, handler); signal.setitimer(signal.ITIMER_REAL, 0.3)
        said = refusal(lambda: b.evaluate(strain(8192)))
        if os.getpid() != parent: os._exit(5 if "spawn" in said else 6)
        print(said, os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]))
        """,
        "no error 5",
    ),
    "Ctrl-C while packings are made": (
        """
        settings = {"packing.void_ratio": 0.2}
        print(stopped(lambda: voussoir.make_packings(32, grains=500, settings=settings)) < 1.5, batch())
        """,
        "True <voussoir.RveBatch of 16 points",
    ),
    "an exception in a signal's handler": (
        """
        b = batch(8192, preset="reference")
        def handler(*_): raise KeyError("from the handler")
        signal.signal(signal.SIGALRM, handler); signal.setitimer(signal.ITIMER_REAL, 0.3)
        try: [b.evaluate(strain(8192)) for _ in range(20)]
        except KeyError as error: print(error)
        """,
        "from the handler",
    ),
    "a signal's handler that uses the batch": (
        """
        b = batch(8192, preset="reference")
        for work in (b.commit, b.close):
            signal.signal(signal.SIGALRM, lambda *_, work=work: work()); signal.setitimer(signal.ITIMER_REAL, 0.3)
            print(refusal(lambda: [b.evaluate(strain(8192)) for _ in range(20)])[:17])
        """,
        "a signal's handle\na signal's handle",
    ),
    "another OpenMP runtime in the process": (
        """
        from sklearn.cluster import KMeans
        x = np.random.default_rng(1).random((20000, 4))
        fit = lambda: KMeans(4, n_init=1, random_state=1).fit(x).inertia_
        b = batch(256); one = b.evaluate(strain(256)).stress; alone = fit()
        thread = threading.Thread(target=fit); thread.start()
        print((b.evaluate(strain(256)).stress == one).all()); thread.join(); print(fit() == alone)
        """,
        "True\nTrue",
    ),
    "many batches that nobody closes": (
        """
        p = voussoir.make_packings(grains=40)
        for _ in range(100): b = voussoir.RveBatch(p, 4)
        print(b.evaluate(strain(4)).usable)
        """,
        "True",
    ),
    "a batch in a pickle": (
        "import pickle\ntry: pickle.dumps(batch())\nexcept TypeError as error: print(error)",
        "pickle",
    ),
    "processes by spawn": (
        """
        import multiprocessing
        b = batch()
        with multiprocessing.get_context("spawn").Pool(1) as pool: print(pool.apply(voussoir.threads) > 0)
        """,
        "True",
    ),
}


def abuse(name):
    code, expected = ABUSES[name]
    words = [sys.executable, "-c", BEGIN + textwrap.dedent(code)]
    try:
        done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return f"{name}: hangs"
    status = 3 if "SystemExit(3)" in code else 0
    if done.returncode != status or expected not in done.stdout or "terminate" in done.stderr:
        return f"{name}: ends with {done.returncode} and says {done.stdout!r} {done.stderr[-600:]!r}"
    return ""


def check_links():
    """What the module needs and shows. HDF5, Gmsh, CHOLMOD and Kokkos of others must never meet ours."""
    module = Path(str(voussoir.engine.core().__file__))
    said = subprocess.run(["readelf", "-d", module], check=True, capture_output=True, text=True).stdout
    needed = {line.split("[")[1].split(".so")[0] for line in said.splitlines() if "(NEEDED)" in line}
    allowed = {"libgomp", "libstdc++", "libgcc_s", "libm", "libc", "ld-linux-x86-64"}
    check(
        needed <= allowed | {"libfmt"}, f"the module needs {sorted(needed)}"
    )  # fmt is inside a wheel, not in a build tree
    said = subprocess.run(["nm", "-D", "--defined-only", module], check=True, capture_output=True, text=True).stdout
    shown = {line.split()[-1] for line in said.splitlines()}
    check(shown == {"PyInit__core"}, f"the module shows {sorted(shown)[:9]}")


check_links()
missing = "another OpenMP runtime in the process"
if importlib.util.find_spec("sklearn") is None:
    print(f"left out, since scikit-learn is missing: {missing}")
    del ABUSES[missing]
with ThreadPoolExecutor(2) as pool:
    faults = [fault for fault in pool.map(abuse, sys.argv[1:] or ABUSES) if fault]
check(not faults, "\n".join(faults))
print(f"{len(ABUSES)} abuses end well")
