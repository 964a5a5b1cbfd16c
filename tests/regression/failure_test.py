"""An increment that finds no equilibrium: exit code 3, what, where and when in the log, nothing recorded as converged."""

from program import check, command, fresh, run, table

SETTINGS = ["volume_loss.total=2 %", "volume_loss.increments=4"]
TOO_STRICT = [*SETTINGS, "newton.tolerance=1e-15", "newton.maximum_iterations=2", "newton.smallest_cut=0.5"]

failed = fresh("failed")
done = run(command("tunnel_elastic", failed, TOO_STRICT), code=3)
check(done.stderr.count("\n") == 1 and "run.log" in done.stderr, f"not one line on stderr: {done.stderr}")
log = (failed / "run.log").read_text()
check("failed: max_iterations in the increment from" in log, f"the log does not say what failed where: {log[-500:]}")
check(all(row["converged"] == 1 for row in table(failed)), "an increment that did not converge is recorded as one that did")
run(command("tunnel_elastic", failed, TOO_STRICT, "--resume"), code=3)

# An opening that would be drawn through itself is refused by the finite elements, not computed.
folded = fresh("folded")
run(command("tunnel_elastic", folded, ["volume_loss.total=90 %", "volume_loss.increments=1", "newton.smallest_cut=1"]), code=3)
last = table(folded)[-1]
check(last["volume_loss"] == 0 and last["converged"] == 1, f"the last record is {last}")
