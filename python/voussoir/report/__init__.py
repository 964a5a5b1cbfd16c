"""One HTML page of a run, an ensemble or a sweep, which needs no server and no network: tools/report, README.md."""
