"""The pages of docs/reference agree with the program and with the tools: commands and options, exit statuses, the
figures of each kind, and the paper's figures."""

import re
import sys

from program import PROGRAM, ROOT, check, run

sys.path.insert(0, str(ROOT / "python"))
from voussoir.figures import catalogue

REFERENCE = ROOT / "docs/reference"


def section_of(page, heading):
    """The text below a heading of the second level."""
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL)
    check(found is not None, f"figures.md has no section {heading}")
    return found.group(1) if found else ""


def check_made_parts():
    """What tools/reference_pages.py writes is what the pages hold."""
    tool = str(ROOT / "tools/reference_pages.py")
    done = run([sys.executable, tool, "--program", PROGRAM, "--check"], code=None)
    check(done.returncode == 0, done.stderr.strip())


def check_commands():
    """Every command and every long option of the program is in the page, each once as a heading."""
    page = (REFERENCE / "command_line.md").read_text()
    listed = run([PROGRAM, "--help"]).stdout.split("Subcommands:\n")[1].split("\n\n")[0]
    commands = re.findall(r"^  (\w+)", listed, re.MULTILINE)
    check(len(commands) > 5, f"--help lists only {commands}")
    for name in commands:
        check(page.count(f"### voussoir {name}\n") == 1, f"command_line.md has no section for {name}")
        for option in set(re.findall(r"--[a-z-]+", run([PROGRAM, name, "--help"]).stdout.split("exit status:")[0])):
            check(option in page, f"command_line.md lacks {option} of {name}")
    print(f"{len(commands)} commands with their options are in command_line.md")


def check_figures():
    """The page has for each sort of source the files of the catalogue, no fewer and no more."""
    page = (REFERENCE / "figures.md").read_text()
    for what in catalogue.OF:
        rows = set(re.findall(r"^\| `([\w.]+)` \|", section_of(page, f"Of {what}"), re.MULTILINE))
        wanted = set(catalogue.figures_of(what))
        check(rows == wanted, f"figures.md, {what}: missing {wanted - rows}, not drawn any more {rows - wanted}")
        print(f"figures.md has the {len(rows)} figures of {what}")


def main():
    check_made_parts()
    check_commands()
    check_figures()


if __name__ == "__main__":
    main()
