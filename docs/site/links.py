"""Checks the links of the pages of a site that mdBook has made: every file and every place within a page that is linked to exists.

    python3 docs/site/links.py target/book
"""

import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Links and names of places of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            elif name == "id" and value is not None:
                self.places.add(value)


@cache
def read(path: Path) -> Page:
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def broken(page: Path, link: str) -> bool:
    """Whether a link of a page leads nowhere; other sites are not asked."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return False
    target = page.parent / unquote(parts.path) if parts.path else page
    if target.suffix != ".html" or not target.exists() or target.name == "lab.html":
        return not target.is_file()
    place = unquote(parts.fragment)
    return place not in ("", *read(target).places)


site = Path(sys.argv[1])
# The references have tests of their own: rustdoc refuses links that lead nowhere.
pages = [page for page in site.rglob("*.html") if page.name != "lab.html" and (site / "api") not in page.parents]
links = [(page, link) for page in pages for link in read(page).links]
found = [f"{page.relative_to(site)}: {link}" for page, link in links if broken(page, link)]
if found:
    sys.exit("these links of the site lead nowhere:\n" + "\n".join(found))
if len(pages) < 20 or len(links) < 1000:
    sys.exit(f"{site} has only {len(pages)} pages and {len(links)} links")
print(f"{len(links)} links of {len(pages)} pages lead somewhere")
