"""An increment that finds no equilibrium: exit code 3, what, where and when in the log, nothing recorded as
converged."""

from program import check, command, fresh, run, table

SETTINGS = ["volume_loss.total=2 %", "volume_loss.increments=4", "newton.relax_substeps=0"]
TOO_STRICT = [*SETTINGS, "newton.tolerance=1e-15", "newton.maximum_iterations=2", "newton.smallest_cut=0.5"]

failed = fresh("failed")
done = run(command("tunnel_elastic", failed, TOO_STRICT), code=3)
check(done.stderr.count("\n") == 1 and "run.log" in done.stderr, f"not one line on stderr: {done.stderr}")
log = (failed / "run.log").read_text()
check("failed: max_iterations in the increment from" in log, f"the log does not say what failed where: {log[-500:]}")
check(
    all(row["converged"] == 1 for row in table(failed)),
    "an increment that did not converge is recorded as one that did",
)
run(command("tunnel_elastic", failed, TOO_STRICT, "--resume"), code=3)

# A step too large for its iterations, in the middle of a run: what was reached before it stays, and is gone on from.
large = fresh("large")
STEP = [
    "volume_loss.total=90 %",
    "volume_loss.increments=1",
    "newton.smallest_cut=1",
    "newton.maximum_iterations=4",
    "newton.relax_substeps=0",
]
run(command("tunnel_elastic", large, STEP), code=3)
last = table(large)[-1]
check(last["stage"] == "volume_loss" and last["volume_loss"] == 0, f"the last record is {last}")
log = (large / "run.log").read_text()
check("volume_loss failed: max_iterations in the increment from 0 to 0.9" in log, f"the log: {log[-500:]}")
gravity = log.count("gravity 29/29")
run(command("tunnel_elastic", large, STEP, "--resume"), code=3)
check((large / "run.log").read_text().count("gravity 29/29") == gravity, "resume did the gravity stage again")

# A relaxation that finds no equilibrium is a failure like any other.
restless = fresh("restless")
run(command("tunnel_elastic", restless, [*TOO_STRICT, "newton.relax_substeps=3"]), code=3)
log = (restless / "run.log").read_text()
check("substeps of a relaxation that found no equilibrium" in log, f"the log: {log[-500:]}")
check(all(row["converged"] == 1 for row in table(restless)), "a relaxation that found no equilibrium is recorded")
