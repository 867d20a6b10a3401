"""Live pages in the browser, for the tests of this folder."""

import functools
from types import SimpleNamespace

from partialslip.scene.reading import load_scene
from partialslip.study.live import live_page

LARGE = "hertz-large-tension"
made = functools.cache(live_page)


def opened(browser, folder, scene=None, change=lambda text: text, **window):
    """Load the page of a scene in the browser."""
    path = folder / "page.html"
    path.write_text(change(made(scene or load_scene(LARGE))), "utf-8")
    browser.open(path, **window)
    return browser


def answer(page):
    """Return the page's solution for the loads that its controls show."""
    return SimpleNamespace(**page.run("page.answer()"))
