"""tools/docs builds the site of all documents without a warning and in time: every page is in the navigation and in the
index of the search, every formula is drawn and every link leads somewhere. A small tree with one fault of each kind
shows that each is told."""

import json
import re
import resource
import sys
from pathlib import Path

from program import ROOT, check, fresh, run

TOOL = ROOT / "tools/docs"
LIMIT = 30  # seconds of a processor for the whole site: its build has one thread, and other tests run beside it
HOST = "https://example.org"
if not (ROOT / ".prefix/docs/bin/python").exists():
    print("skipped: the documents' Python packages are missing; tools/setup --docs or --test installs them")
    sys.exit(77)

# A page with one fault of each kind, by the sentence that tells it.
PAGE = r"""# A page

[A file](nothing.md), [a section](README.md#nowhere), [another](#here), [a folder](empty), [outside](../../../x.md).
![a picture](lost.png) <a href="gone.html">gone</a>

## Here

The formula $\unknown{x}$, and a $ alone. A good one: $\frac{1}{2} \boldsymbol{\sigma}$.

A **bold word **, a link ([[here](#here)](page.md)), a note[^1]. `good: ** ]( $ [^1]`

| a | b |
|---|---|
| 1 | 2 |

| 3 | 4 |
"""
FAULTS = [
    "docs/tutorial/page.md:3: nothing.md: there is no such file",
    "docs/tutorial/page.md:3: README.md#nowhere: the page has no such section",
    "docs/tutorial/page.md:3: empty: the folder has no README.md",
    "docs/tutorial/page.md:3: ../../../x.md: the link leaves the repository",
    "docs/tutorial/page.md:3: lost.png: there is no such file",
    "docs/tutorial/page.md:3: gone.html: there is no such file",
    r"docs/tutorial/page.md:8: the formula '\\unknown{x}' is not understood",
    "docs/tutorial/page.md:8: a $ outside code neither begins nor ends a formula",
    "docs/tutorial/page.md:10: a ** outside code neither begins nor ends bold text",
    "docs/tutorial/page.md:10: a link is not understood",
    "docs/tutorial/page.md:10: there is no such footnote",
    "docs/tutorial/page.md:16: the row of a table stands outside its table",
    "docs/tutorial/README.md: does not link the page page.md of its section",
    "docs/tutorial/two.md: the page has 2 titles (# ...) instead of one",
    "docs/other/new.md: the folder is no section of the navigation",
    "tools/README.md:2: x.toml: there is no such file",
    "docs/reference/README.md: the index of its section is missing",
]


def write(folder, **files):
    for name, text in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)


def faulty_tree():
    tree = fresh("faulty")
    sections = {"docs/README.md": "# Home\n[page](tutorial/page.md#here)\n", "README.md": "# Program\n[d](docs)\n"}
    for name in ("tutorial", "how-to", "explanation", "validation", "measurements"):
        sections[f"docs/{name}/README.md"] = f"# {name}\n"
    sections["docs/tutorial/README.md"] = "# Tutorials\n- [two](two.md)\n- [a file](../../case.toml)\n"
    further = {"docs/other/new.md": "# New\n", "tools/README.md": "# Tools\n[x](x.toml)\n", "case.toml": "a = 1\n"}
    write(tree, **sections, **further, **{"docs/tutorial/page.md": PAGE, "docs/tutorial/two.md": "# A\n# B\n"})
    (tree / "docs/tutorial/empty").mkdir()
    return tree


def check_faults():
    """Each fault is told, and nothing else is."""
    done = run([str(TOOL), "--root", str(faulty_tree()), "-o", "faulty_site"], code=1)
    told = done.stderr.splitlines()
    for fault in FAULTS:
        check(any(fault in line for line in told), f"not told: {fault}\n{done.stderr}")
    check(len(told) == len(FAULTS) + 1, f"{len(told) - 1} problems instead of {len(FAULTS)}:\n{done.stderr}")


def check_built_links():
    """The check of the built site by itself, on pages that are wrong."""
    site = fresh("wrong_site")
    write(
        site,
        **{
            "a.html": '<p id="x"><a href="b.html#y">1</a> <a href="c.html">2</a> <a href="a.html#x">good</a>',
            "b.html": f'<script src="{HOST}/x.js"></script><a href="{HOST}">good</a><a href="../z">3</a>',
            "c.css": f"p {{ background: url({HOST}/p.png) }}",
        },
    )
    words = "import sys; sys.path.insert(0, sys.argv[1]); from docs_site.check_site import check_site\n"
    words += "from pathlib import Path; print('\\n'.join(check_site(Path(sys.argv[2]))[0]))"
    told = run([sys.executable, "-c", words, str(ROOT / "tools"), str(site)]).stdout
    for sentence in ("no element", "no file", "out of the site", "x.js'> is asked", "p.png is asked"):
        check(sentence in told, f"the check of the site does not tell: {sentence}\n{told}")
    check(told.count("\n") == 5, f"the check of the site tells of what is right:\n{told}")


def check_pages(site):
    """Every page of docs is in the site, in its navigation and in the index of the search."""
    home = (site / "index.html").read_text()
    index = json.loads((site / "search/search_index.json").read_text())
    check((site / "search/search_index.js").read_text().startswith("var __index = {"), "no index for pages from files")
    found = {entry["location"].split("#")[0] for entry in index["docs"]}
    texts = [entry["text"] for entry in index["docs"] if entry["location"].startswith("reference/glossary.html")]
    check(any("√(2eijeij)" in text for text in texts), "the search has the roots of formulas without their sign")
    pages = sorted((ROOT / "docs").rglob("*.md"))
    for page in pages:
        name = page.relative_to(ROOT / "docs").as_posix()
        place = re.sub(r"README\.md$", "index.html", name).replace(".md", ".html")
        check((site / place).is_file(), f"docs/{name} has no page")
        check(f'href="{place}"' in home, f"docs/{name} is not in the navigation")
        check(place in found, f"docs/{name} is not in the index of the search")
    return len(pages)


def check_formulas(site):
    """Every page with a formula has MathML, and no page shows LaTeX in its text."""
    count = 0
    for page in site.rglob("*.html"):
        text = page.read_text()
        count += len(re.findall("<math[ >]", text))
        prose = re.sub(r"<(script|pre|code)\b.*?</\1>", "", text, flags=re.DOTALL)
        shown = re.search(r"\\(?:frac|sum|boldsymbol|sigma|begin|left)\b|\$[^$<]+\$", prose)
        check(not shown, f"{page}: a formula is shown as LaTeX: {shown and shown[0]}")
    return count


def processor_time():
    """What all ended children of this process have used [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


check_built_links()
check_faults()
before = processor_time()
done = run([str(TOOL), "-o", "site"])
took = processor_time() - before
check(not done.stderr, f"warnings: {done.stderr}")
check(took < LIMIT, f"the build took {took:.1f} s of a processor, which is more than {LIMIT} s")
site = Path("site")
pages, formulas = check_pages(site), check_formulas(site)
print(f"{pages} pages of docs, {formulas} formulas, {took:.1f} s of a processor; {done.stdout.strip()}")
