"""What MkDocs calls while it builds the site: MkDocs draws the frame, the navigation and the index of the search; which
pages there are and what stands in them comes from pages.py."""

import html
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.plugins import CombinedEvent, event_priority
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from mkdocs.structure.toc import get_toc

from docs_site.formulas import without_formulas
from docs_site.pages import Site
from docs_site.tree import page_of, place_of


class SitePage(File):
    """A page of the site, whose content MkDocs does not read."""

    def is_documentation_page(self) -> bool:
        return True


def _site(config: MkDocsConfig) -> Site:
    site = config.extra["site"]
    assert isinstance(site, Site)
    return site


def on_config(config: MkDocsConfig) -> None:
    site = _site(config)
    config.nav = site.navigation
    config.copyright = f"Voussoir {site.version()}".strip()


def on_files(files: Files, config: MkDocsConfig) -> Files:
    site = _site(config)
    for file in list(files.documentation_pages()):
        files.remove(file)  # the README.md of assets/
    for path in site.pages:
        page = SitePage(path, None, config.site_dir, False, dest_uri=page_of(path))
        page.generated_by, page.content_string = "docs_site", ""
        files.append(page)
    for path in sorted(site.files):
        file = File(path, None, config.site_dir, False, dest_uri=place_of(path))
        file.generated_by, file.abs_src_path = "docs_site", str(site.root / path)
        # A file that is shown as a page too has the path of its source only once.
        file.src_uri = f"{path} as a file"
        files.append(file)
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, **_others: Any) -> str:
    """Titles are asked for by the pages' own frames, so they are set before the first is drawn."""
    path = page.file.src_uri
    page.meta["title"] = html.escape(_site(config).title(path))
    if path not in _site(config).documents:
        page.meta["search"] = {"exclude": True}
    elif not path.startswith("docs/"):
        page.meta["search"] = {"boost": 0.3}  # notes for developers come after the documents
    return markdown


def _contents(site: Site, path: str) -> list[dict[str, Any]]:
    """The headings of a page as a tree."""
    tree: list[dict[str, Any]] = []
    open_ones: list[dict[str, Any]] = []
    for heading in site.documents[path].headings if path in site.documents else []:
        token = {"level": heading.level, "id": heading.anchor, "name": html.escape(heading.text), "children": []}
        while open_ones and open_ones[-1]["level"] >= heading.level:
            open_ones.pop()
        (open_ones[-1]["children"] if open_ones else tree).append(token)
        open_ones.append(token)
    return tree


def on_page_content(_html: str, page: Page, config: MkDocsConfig, **_others: Any) -> str:
    site, path = _site(config), page.file.src_uri
    page.toc = get_toc(_contents(site, path))
    return site.html(path)


@event_priority(100)
def _before_search(context: Any, page: Page, **_others: Any) -> Any:
    """The search takes the text between tags, in which a formula would lose its roots and exponents."""
    page.meta["drawn"] = page.content
    page.content = without_formulas(page.content or "")
    return context


@event_priority(-100)
def _after_search(context: Any, page: Page, **_others: Any) -> Any:
    page.content = page.meta.pop("drawn")
    return context


on_page_context = CombinedEvent(_before_search, _after_search)
