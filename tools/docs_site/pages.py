"""The site as a whole, before anything is drawn: all documents, what they link, the navigation and all problems."""

import posixpath
import re
from pathlib import Path

from docs_site.document import Document, code_block
from docs_site.navigation import navigation
from docs_site.tree import Kind, LinkError, is_external, kind_of, markdown_files, page_of, place_of, target_of


class Site:
    """`documents` are the Markdown files by path, `texts` the other files that are shown as pages, `files` those that
    are copied. Paths start at the root of the checkout."""

    def __init__(self, root: Path):
        self.root = root
        self.problems: list[str] = []
        self.texts: set[str] = set()
        self.files: set[str] = set()
        self.documents = {path: Document(path, (root / path).read_text()) for path in markdown_files(root)}
        for document in self.documents.values():
            self.problems += document.problems
            self._follow_links(document)
            if document.path.startswith("docs/"):
                self._check_titles(document)
        self.navigation = navigation(root, self.documents, self.problems)

    @property
    def pages(self) -> list[str]:
        return [*self.documents, *sorted(self.texts)]

    def title(self, path: str) -> str:
        """A document's title; a README outside docs, and a file that is shown, is known by its path."""
        if path in self.documents and path.startswith("docs/"):
            return self.documents[path].title
        return posixpath.dirname(path) if path.endswith("/README.md") else path

    def html(self, path: str) -> str:
        if path in self.documents:
            return self.documents[path].html(lambda href: self._resolve(path, href))
        folder, name = posixpath.split(path)
        about = ""
        if posixpath.join(folder, "README.md") in self.documents:
            about = f' · <a href="{self._resolve(path, "README.md")}">About its folder</a>'
        return (
            f'<h1>{path}</h1>\n<p><a href="{name}" download>Save this file</a>{about}</p>\n'
            f"{code_block((self.root / path).read_text(), '', name)}"
        )

    def version(self) -> str:
        """The program's version, from the project's CMakeLists.txt."""
        file = self.root / "CMakeLists.txt"
        found = (
            re.search(r"^\s*(?:project\(\w+\s+)?VERSION\s+([\d.]+)", file.read_text(), re.MULTILINE)
            if file.exists()
            else None
        )
        return found[1] if found else ""

    def _follow_links(self, document: Document) -> None:
        """Notes what a document links, and every link that leads nowhere."""
        for link in document.links:
            if is_external(link.href):
                continue
            try:
                target = target_of(self.root, document.path, link.href)
            except LinkError as error:
                self.problems.append(f"{document.path}:{link.line}: {link.href}: {error}")
                continue
            kind = kind_of(self.root / target.path)
            if kind == Kind.TEXT:
                self.texts.add(target.path)
            if kind != Kind.MARKDOWN:
                self.files.add(target.path)
            anchors = self.documents[target.path].anchors if target.path in self.documents else set()
            if target.anchor and target.anchor not in anchors:
                self.problems.append(f"{document.path}:{link.line}: {link.href}: the page has no such section")

    def _check_titles(self, document: Document) -> None:
        count = sum(heading.level == 1 for heading in document.headings)
        if count != 1:
            self.problems.append(f"{document.path}: the page has {count} titles (# ...) instead of one")

    def _resolve(self, path: str, href: str) -> str:
        """A link of the repository as a link between the site's files."""
        if is_external(href) or href.startswith("#"):
            return href
        try:
            target = target_of(self.root, path, href)
        except LinkError:
            return href  # told already
        copied = kind_of(self.root / target.path) == Kind.FILE
        place = place_of(target.path) if copied else page_of(target.path)
        relative = posixpath.relpath(place, posixpath.dirname(page_of(path)) or ".")
        return f"{relative}#{target.anchor}" if target.anchor else relative
