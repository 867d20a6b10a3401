"""Pages and drawings, read back."""

import html.parser
import json
from xml.etree import ElementTree

import pytest


class Outline(html.parser.HTMLParser):
    """Tags of a page with their attributes, its links, its text, its scripts, and the text of the cells of tables by
    row; an end tag that closes nothing is an error."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.links, self.text, self.scripts, self.rows = [], [], [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.handle_startendtag(tag, attributes)
        if tag not in ("meta", "link", "br", "hr", "img", "input"):
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        self.links += [value for key, value in attributes if key in ("href", "xlink:href", "src", "data", "action")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        (self.scripts if "script" in self.open else self.text).append(data)
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data

    @property
    def names(self):
        return [tag for tag, _ in self.tags]

    @property
    def scene(self):
        """The data of a live page."""
        return json.loads(self.scripts[0], parse_constant=lambda token: pytest.fail(token))


def texts(svg):
    """Return all texts of an SVG, which must be well-formed."""
    return ["".join(node.itertext()) for node in ElementTree.fromstring(svg).iter() if node.tag.endswith("}text")]
