"""The lists of keys: they are those of the readers, the pages made of them are current, and the schemas accept all
cases and refuse what a schema can refuse. jsonschema is installed by tools/setup --test."""

import csv
import importlib
import io
import json
import re
import tomllib
from collections import Counter

from bad_settings import LINES, SCENES, SETTINGS, SWEEPS, UNIT
from key_limits import KINDS, keys_of_kind, limits_of, lines_of, wrong_forms
from program import PROGRAM, ROOT, check, run

# It has no types of its own, and mypy need not find it.
Draft202012Validator = importlib.import_module("jsonschema").Draft202012Validator
READERS = [*sorted((ROOT / "host/case").glob("*.?pp")), *sorted((ROOT / "host/sweep").glob("*.?pp")),
           ROOT / "io/case_node.hpp"]  # fmt: skip
LITERAL = r'"(?:[^"\\]|\\.)*"'
# A key as it stands in the source (io/key.hpp): a name and a sentence, which may be several literals, in braces.
KEY = re.compile(rf"\{{\s*({LITERAL})\s*,\s*((?:{LITERAL}\s*)+)\}}")
PAGES = {
    "docs/reference/keys.md": ["--markdown"],
    "docs/reference/case.schema.json": ["--json-schema"],
    "docs/reference/sweep.schema.json": ["sweep", "--json-schema"],
}


def keys(*words):
    return run([PROGRAM, "keys", *words]).stdout


def text_of(literals):
    return "".join(json.loads(one) for one in re.findall(LITERAL, literals))


def keys_in(source):
    """(name, sentence) of each key in the text of a source."""
    found = {(text_of(name), text_of(sentence)) for name, sentence in KEY.findall(source)}
    return {(name, sentence) for name, sentence in found if re.fullmatch(r"[A-Z].*\.", sentence, re.DOTALL)}


def last_part(key):
    return key[key.rindex('"', 0, -1) :] if key.endswith('"') else key.rsplit(".", 1)[-1]


def listed_keys():
    rows = list(csv.DictReader(io.StringIO(keys())))
    return {(last_part(row["key"]), row["help"]) for row in rows}


def tables_of(schema):
    """(name, description) of every property and every entry that a schema has."""
    found = set()
    if isinstance(schema, dict):
        for name, inner in schema.get("properties", {}).items():
            if isinstance(inner, dict) and "description" in inner:
                found.add((name, inner["description"]))
        named = schema.get("additionalProperties")
        for inner in named["anyOf"] if isinstance(named, dict) else []:
            found.add(("", inner["description"]))
    for inner in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else []:
        found |= tables_of(inner)
    return found


def keys_without_a_list(in_sources, in_lists, described):
    """The keys of the sources that no list has. A table's sentence begins a description of a schema."""
    return [
        (name, sentence)
        for name, sentence in sorted(in_sources - in_lists)
        if not any(known in (name, "") and text.startswith(sentence) for known, text in described)
    ]


# Every key that stands in a reader is listed, whichever choices lead to it, and every key of the lists stands there.
in_sources = set().union(*(keys_in(source.read_text()) for source in READERS))
in_lists = listed_keys()
schemas = {name: json.loads(keys(*words)) for name, words in PAGES.items() if name.endswith(".json")}
described = set().union(*map(tables_of, schemas.values()))
missing = keys_without_a_list(in_sources, in_lists, described)
check(not missing, f"a reader has keys that `voussoir keys` does not list: {missing}")
check(in_lists <= in_sources, f"listed, but in no reader: {sorted(in_lists - in_sources)}")
check(len(in_lists) > 100, f"only {len(in_lists)} keys were found")
new = keys_in('if (never) table.boolean({"new_key", "Explains a key that is read in a branch "\n "alone."}, true);')
check(keys_without_a_list(in_sources | new, in_lists, described) == list(new), "a key in a branch would not be noticed")
print(f"{len(in_lists)} pairs of a key's name and its sentence")

# The pages in the repository are those that this program writes.
for name, words in PAGES.items():
    fault = f"{name} is not current: voussoir keys {' '.join(words)} > {name}"
    check((ROOT / name).read_text() == keys(*words), fault)
for kind in (*KINDS, "sweep"):
    check(keys(kind, "--markdown").startswith("## Keys of"), f"no page of {kind}")
    Draft202012Validator.check_schema(json.loads(keys(kind, "--json-schema")))


# One key, and one table, by name: the lines that the list of all keys has.
ALL_LINES = keys().splitlines()


def names_in(lines):
    return [line.split(",")[0] for line in lines[1:]]


def lines_of_name(name):
    lines = keys(name).splitlines()
    check(lines[0] == ALL_LINES[0] and set(lines) <= set(ALL_LINES), f"{name}: other lines than in the list of all")
    return names_in(lines)


check(lines_of_name("soil.thickness") == ["soil.thickness"], "voussoir keys soil.thickness")
check(lines_of_name("extends") == ["extends"] * 2, "voussoir keys extends: of cases and of sweep files")
for name in ("soil.class.size_to", "soil.class[].size_to", "soil.class[0].size_to"):
    check(lines_of_name(name) == ["soil.class[].size_to"], f"voussoir keys {name}")
of_soil = lines_of_name("soil")
check(of_soil == [name for name in names_in(ALL_LINES) if name.startswith("soil.")], f"voussoir keys soil: {of_soil}")
of_column = [name for name in names_in(ALL_LINES) if name.startswith("column.")]
check(lines_of_name("[column]") == of_column, "brackets do not ask for the table")
check({"ground.height", *of_column} < set(names_in(keys("column").splitlines())), "the kind of the same name")
page = keys("soil.thickness", "--markdown")
check(page.startswith("## Keys of case files\n\n### `[soil]`\n") and page.count("\n| `") == 1, page)

for schema in schemas.values():
    Draft202012Validator.check_schema(schema)
of_case, of_sweep = (Draft202012Validator(schemas[f"docs/reference/{name}.schema.json"]) for name in ("case", "sweep"))


def faults(validator, data):
    return [f"{list(error.absolute_path)}: {error.message[:200]}" for error in validator.iter_errors(data)]


# The schemas accept what lies in cases/. The files of soils are made to be extended, so that they lack the kind.
count: Counter[str] = Counter()
for file in sorted((ROOT / "cases").glob("*/*.toml")):
    data = tomllib.loads(file.read_text())
    is_sweep = "grid" in data or "run" in data
    if file.parent.name == "soils":
        check("extends" in data or faults(of_case, data), f"{file} is accepted without a kind")
        data["kind"] = "pack"
    said = faults(of_sweep if is_sweep else of_case, data)
    check(not said, f"{file} is refused: {said}")
    count["sweeps" if is_sweep else "soils" if file.parent.name == "soils" else "cases"] += 1
check(count["cases"] >= 15 and count["sweeps"] >= 2 and count["soils"] >= 6, f"files are missing: {count}")
print(f"accepted: {dict(count)}")
check(
    not faults(of_case, {"extends": "other.toml", "ground": {"diameter": "5 m"}}), "a file without a kind extends one"
)
of_pack = Draft202012Validator(json.loads(keys("pack", "--json-schema")))
check(not faults(of_pack, {"kind": "pack"}) and faults(of_pack, {"kind": "tunnel"}), "the schema of one kind")


def parsed(text):
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError):
        return None


def with_settings(data, settings):
    """The case with overrides, whose values may lack their quotes as on the command line."""
    for setting in settings:
        key, value = setting.split("=", 1)
        *tables, name = key.split(".")
        table = data
        for one in tables:
            array, _, place = one.partition("[")
            table = table.setdefault(array, [{}] if place else {})
            if place and int(place[:-1]) >= len(table):
                return None
            table = table[int(place[:-1])] if place else table
        given = parsed(f"value = {value}")
        if given is None and re.match(r"[\[{]", value):
            return None
        table[name] = value if given is None else given["value"]
    return data


def judge(validator, data, reason, what, counts):
    """Counts whether a schema refuses the data; None is no TOML, which an editor says without a schema."""
    refused = data is None or bool(faults(validator, data))
    check(refused or reason, f"the schema accepts {what}")
    check(
        data is None or not (refused and reason), f"the schema refuses {what}, which was held to be beyond it: {reason}"
    )
    counts[reason or "refused by the schema"] += 1


elastic = (ROOT / "cases/tunnel_elastic/case.toml").read_text()
counts: Counter[str] = Counter()
for text, _, reason in LINES:
    judge(of_case, parsed(f"{elastic}\n{text}\n"), reason, text, counts)
for settings, _, reason in SETTINGS:
    judge(of_case, with_settings(tomllib.loads(elastic), settings), reason, str(settings)[:100], counts)
trapdoor = (ROOT / "cases/trapdoor/case.toml").read_text()
for settings, _, reason in SCENES:
    judge(of_case, with_settings(tomllib.loads(trapdoor), settings), reason, str(settings)[:100], counts)
for text, _, reason in SWEEPS:
    judge(of_sweep, parsed(f"base = 'case.toml'\n{text}"), reason, text, counts)
print(f"wrong input of bad_input_test.py: {dict(counts)}")

# Every key of every kind one step outside its limits, and with values of wrong forms.
UNSEEN_FORMS = re.compile(r"""(?x)
    1\.0 | 1e3 | nan                 # JSON does not tell 1.0 from 1, and has no nan
  | "1e-?400.*"                      # a number too large or too small for a double
  | "x"  | "x{300,3000}" | "no_such_file.csv" | "\." | "/dev/null"    # texts and files are not looked at
  | 9{400}\.0""")


def excuse_of(value):
    """Why a schema may accept a value of a wrong form; empty where it must not."""
    inner = value[1:-1] if value.startswith("[") else value
    return "a form that JSON does not tell, or a file" if UNSEEN_FORMS.fullmatch(inner) else ""


def wrong_values(key):
    """(value, why a schema may accept it) of a key."""
    for _, _, outside, _ in limits_of(key):
        yield outside, UNIT if key["dimension"] or "place" in key["type"] else ""
    for form in wrong_forms(key):
        yield form, excuse_of(form)


def first_of_each():
    """(kind, key) of each key once."""
    known: set[str] = set()
    for kind in KINDS:
        for key in keys_of_kind(kind):
            if key["key"] not in known | {"extends"}:
                known.add(key["key"])
                yield kind, key


tried: Counter[str] = Counter()
for kind, key in first_of_each():
    for value, excuse in wrong_values(key):
        data = parsed(lines_of(kind, {key["key"]: value})[0])
        refused = data is None or bool(faults(of_case, data))
        check(refused or excuse, f"the schema accepts {key['key']} = {value[:80]}")
        tried["refused by the schema" if refused else excuse] += 1
print(f"wrong values of all keys: {dict(tried)}")
