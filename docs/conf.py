"""Sphinx's settings: sphinx-build -W --keep-going docs docs/_build/html."""

import sys
from pathlib import Path

import partialslip

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

project = "partialslip"
author = "The partialslip developers"
copyright = "The partialslip developers, MIT licence"
version = release = partialslip.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "commands", "docstrings", "mathml"]
autodoc_default_options = {"members": True}
autodoc_typehints = "none"  # docstrings say shapes and units, signatures would only say arrays
autodoc_preserve_defaults = True
napoleon_use_param = False  # shapes such as (n,) are no links to whatever is called n
napoleon_use_rtype = False
exclude_patterns = ["_build"]
myst_enable_extensions = ["dollarmath", "attrs_block"]
myst_heading_anchors = 3
html_math_renderer = "mathml"
html_theme = "furo"
html_title = "partialslip"
html_static_path = ["static"]
html_css_files = ["partialslip.css"]
html_copy_source = False
