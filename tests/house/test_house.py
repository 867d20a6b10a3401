"""The house grows on purpose: a figure beyond its line in house.txt by more than 5 % needs that line changed."""

import measuring

WRITTEN = measuring.read(measuring.TABLE.read_text("utf-8"))


def grown(figures, written):
    return {
        name: (written[name], figure) for name, figure in figures.items() if figure > measuring.GROWTH * written[name]
    }


def test_nothing_has_grown_unnoticed():
    """After growth that is meant: python tests/house/measuring.py, and the reason in the commit."""
    figures = measuring.measure()
    assert set(figures) == set(WRITTEN)
    assert grown(figures, WRITTEN) == {}


def test_growth_is_noticed():
    assert grown({"modules": 106, "floors": 11}, {"modules": 100, "floors": 11}) == {"modules": (100, 106)}


def test_code_is_counted_without_words():
    text = '"""Module.\n\nMore."""\n\n# why\nx = 1  # one\n\n\ndef f():\n    """What."""\n    return """a\nb"""\n'
    assert measuring.code_lines(text) == 4
