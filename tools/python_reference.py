"""The public names of the Python package voussoir with their docstrings, as Markdown, which tools/reference_pages.py
writes into docs/reference/python.md.

The sources are read and not imported, so that the page needs neither the compiled module nor what single modules
import. A name without a docstring is an error: the page is the only complete list.
"""

import ast
import inspect
import re
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).resolve().parent.parent / "python" / "voussoir"
TITLES = {"Args": "Arguments", "Returns": "Returns", "Raises": "Raises"}  # sections of a docstring
ENTRY = re.compile(r" {4}(?P<names>\w+(?:, \w+)*): (?P<text>.*)")
LINE = 100  # the longest signature in one line
SUBMODULES = ("paths", "precice")  # figures and report are drawn by functions of the results


class Module:
    """The source of a module of the package."""

    def __init__(self, name: str) -> None:
        place = PACKAGE.joinpath(*name.split("."))
        self.name = name
        self.text = (place / "__init__.py" if place.is_dir() else place.with_suffix(".py")).read_text(encoding="utf-8")
        self.lines = self.text.splitlines()
        self.tree = ast.parse(self.text)
        self.definitions = {
            node.name: node for node in self.tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)
        }

    def constant(self, name: str) -> Any:
        """The value of an assignment at the top."""
        for node in self.tree.body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == name:
                return ast.literal_eval(node.value)
        raise LookupError(f"python/voussoir/{self.name} has no {name}")

    def origin(self, name: str) -> "tuple[Module, str]":
        """The module that defines a name which this one may only import from its neighbours, and the name there."""
        for node in self.tree.body:
            if isinstance(node, ast.ImportFrom) and node.level == 1:
                for alias in node.names:
                    if (alias.asname or alias.name) == name:
                        return Module(f"{self.name}.{node.module}"), alias.name
        return self, name


def public_names() -> dict[str, list[str]]:
    """The public names of each module: of those whose names are the package's own, and of the submodules."""
    names = dict(Module("__init__").constant("_MODULES"))
    return names | {module: Module(module).constant("__all__") for module in SUBMODULES}


def code(text: str) -> str:
    return f"```python\n{text}\n```"


def decorators(node: ast.FunctionDef) -> set[str]:
    return {
        d.id if isinstance(d, ast.Name) else d.attr
        for d in node.decorator_list
        if isinstance(d, ast.Name | ast.Attribute)
    }


def documentation(node: ast.FunctionDef | ast.ClassDef) -> str:
    return with_lists(inspect.cleandoc(ast.get_docstring(node, clean=False) or ""))


def with_lists(text: str) -> str:
    """A docstring whose sections "Args:", "Returns:", "Raises:" are lists, which Markdown would join into one line."""
    lines: list[str] = []
    inside = ""
    for line in text.splitlines():
        if line.removesuffix(":") in TITLES and line.endswith(":"):
            inside = line.removesuffix(":")
            lines += [f"{TITLES[inside]}:", ""]
        elif not inside or not line.startswith(" ") or inside == "Returns":
            lines.append(line.strip() if inside == "Returns" else line)
        elif found := ENTRY.fullmatch(line):
            names = ", ".join(f"`{name}`" for name in found["names"].split(", "))
            lines.append(f"- {names}: {found['text']}")
        else:
            lines.append(f"  {line.strip()}")
    return "\n".join(lines)


def split_arguments(text: str) -> list[str]:
    """What stands between the commas outside of all brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]


def signature(node: ast.FunctionDef, name: str, bound: bool) -> str:
    """`name(a, b=1) -> what`; each argument has a line of its own where one line would be too long.

    bound: the first argument is the object, and the caller does not give it."""
    arguments = split_arguments(ast.unparse(node.args))[int(bound) :]
    returns = f" -> {ast.unparse(node.returns)}" if node.returns and node.name != "__init__" else ""
    whole = f"{name}({', '.join(arguments)}){returns}"
    if len(whole) <= LINE:
        return whole
    return "\n".join([f"{name}(", *(f"    {argument}," for argument in arguments), f"){returns}"])


def member(node: ast.FunctionDef, name: str) -> str:
    """A method or a property; nothing where it is not public or repeats what another one says."""
    kinds = decorators(node)
    if node.name.startswith("_") or "setter" in kinds or not documentation(node):
        return ""
    if kinds & {"property", "cached_property"}:
        head = f"{name}: {ast.unparse(node.returns)}" if node.returns else name
    else:
        head = signature(node, name, bound="staticmethod" not in kinds)
    return f"{code(head)}\n\n{documentation(node)}"


def fields(module: Module, node: ast.ClassDef) -> str:
    """The fields of a dataclass or a named tuple, each with the comment `#:` behind it."""
    lines = []
    for field in node.body:
        if not isinstance(field, ast.AnnAssign) or not isinstance(field.target, ast.Name):
            continue
        comment = module.lines[field.lineno - 1].partition("#:")[2].strip()
        if comment:
            lines.append(f"- `{field.target.id}`: {comment}")
    return "\n".join(lines)


def members(module: Module, node: ast.ClassDef, name: str) -> list[str]:
    """Fields, properties and methods, those of base classes in the same module too."""
    own = [
        fields(module, node),
        *(member(part, f"{name}.{part.name}") for part in node.body if isinstance(part, ast.FunctionDef)),
    ]
    for base in node.bases:
        found = module.definitions.get(base.id) if isinstance(base, ast.Name) else None
        if isinstance(found, ast.ClassDef):
            own += members(module, found, name)
    return [part for part in own if part]


def class_section(module: Module, node: ast.ClassDef) -> list[str]:
    start = next((part for part in node.body if isinstance(part, ast.FunctionDef) and part.name == "__init__"), None)
    parts = []
    if start is not None and "Exception" not in node.name:
        parts = [code(signature(start, node.name, bound=True)), documentation(start)]
    return [*parts[:1], documentation(node), *parts[1:], *members(module, node, node.name)]


def comment_above(module: Module, name: str) -> str:
    """The comment `#:` above a constant."""
    row = next(k for k, line in enumerate(module.lines) if line.startswith((f"{name} =", f"{name}:")))
    first = row
    while first > 0 and module.lines[first - 1].startswith("#:"):
        first -= 1
    return "\n".join(line.removeprefix("#:").removeprefix(" ") for line in module.lines[first:row])


def section(module: Module, name: str) -> str:
    """All that the page says of one public name."""
    module, own_name = module.origin(name)
    node = module.definitions.get(own_name)
    if isinstance(node, ast.ClassDef):
        parts = class_section(module, node)
    elif isinstance(node, ast.FunctionDef):
        parts = [code(signature(node, name, bound=False)), documentation(node)]
    else:
        parts = [comment_above(module, own_name)]
    text = "\n\n".join(part for part in parts if part)
    if not text:
        raise LookupError(f"voussoir.{name} has no docstring")
    return f"### {name}\n\n{text}"


def page() -> str:
    """The sections of all public names, module by module in the order of the table."""
    parts = []
    for module_name, names in public_names().items():
        module = Module(module_name)
        head = (ast.get_docstring(module.tree) or "").split("\n\n")[0].replace("\n", " ")
        parts.append(f"## voussoir.{module_name}\n\n{head}")
        parts.extend(section(module, name) for name in names)
    return "\n\n".join(parts)
