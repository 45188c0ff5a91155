"""A report's HTML as the tests look at it."""

from dataclasses import dataclass, field
from html.parser import HTMLParser

VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
# Attributes whose address a browser fetches by itself; `a href` it does not.
FETCHED = {"src", "srcset", "poster", "data", "background", "action", "formaction"}


@dataclass
class Seen(HTMLParser):
    open: list = field(default_factory=list)
    faults: list = field(default_factory=list)
    names: list = field(default_factory=list)
    tags: list = field(default_factory=list)
    fetched: list = field(default_factory=list)
    sections: dict = field(default_factory=dict)
    scripts: list = field(default_factory=list)
    styles: list = field(default_factory=list)
    plots: int = 0

    def __post_init__(self):
        super().__init__(convert_charrefs=True)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.tags.append((tag, found))
        self.fetched += [
            (tag, name, value) for name, value in attributes if name in FETCHED or (tag == "link" and name == "href")
        ]
        if "id" in found:
            self.names.append(found["id"])
        if tag == "section":
            self.sections[found["id"]] = ""
        self.plots += found.get("class") == "curves"
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag in VOID or not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data):
        if "script" in self.open:
            self.scripts.append(data)
        elif "style" in self.open:
            self.styles.append(data)
        elif "section" in self.open:
            self.sections[list(self.sections)[-1]] += data


def seen(file) -> Seen:
    page = Seen()
    page.feed(file.read_text(encoding="utf-8"))
    page.close()
    page.faults += [f"<{tag}> is not closed" for tag in page.open]
    return page
