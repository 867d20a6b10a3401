"""Self-contained HTML pages in one common frame."""

from collections.abc import Sequence

from partialslip.output.template import template


def render_page(
    package: str,
    name: str,
    *,
    title: str,
    origin: Sequence[tuple[str, str]],
    subtitle: str = "",
    verdict: str = "",
    **content: object,
) -> str:
    """Return a page as HTML: title, verdict and origin, then the blocks of a template.

    Parameters
    ----------
    package, name : str
        Package and name of a template that extends ``page.html``.
    title, subtitle : str
    origin : sequence of (str, str)
        Rows of key and text: date, command, versions.
    verdict : str
        Text of the verdict box; empty for no box.
    **content
        Variables of the template.
    """
    frame = {"title": title, "subtitle": subtitle, "origin": origin, "verdict": verdict}
    return template(package, name).render(**frame, **content) + "\n"
