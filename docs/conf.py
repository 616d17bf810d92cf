"""How the documentation site is built: ``make docs`` runs ``sphinx-build -c docs . build/docs``.

The source is the whole repository, so that notebooks and derivations are read where they stand,
and a link between two files means the same here as on a code host.
"""

from importlib.util import find_spec
from pathlib import Path
from sys import path

import railride

HERE = Path(__file__).parent
path.insert(0, str(HERE / "extensions"))

project = "railride"
author = "the railride authors"
version = release = railride.__version__
language = "en"
root_doc = "docs/index"
include_patterns = [
    "docs/**.md",
    "docs/**.rst",
    "derivations/*.md",
    "notebooks/*.ipynb",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
]
# What is nowhere looked into; the rest that stands in these folders is there to be linked to.
exclude_patterns = [".*", "build", "dist", "src", "tests", "**/.ipynb_checkpoints"]

extensions = [
    "command_line",
    "docstrings",
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinxcontrib.bibtex",
]

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 88
add_module_names = False
toc_object_entries_show_parents = "hide"

# Notebooks are shown with the outputs they carry; tests run them.
nb_execution_mode = "off"
nb_number_source_lines = False
myst_enable_extensions = ["amsmath", "dollarmath"]
myst_dmath_double_inline = True
myst_heading_anchors = 4
bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"

html_theme = "furo"
html_title = f"railride {release}"
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
html_css_files = ["site.css"]
html_extra_path = ["_extra"]
# MathJax with its fonts goes into the site: it is read without a network too.
html_static_path = [
    "_static",
    str(Path(find_spec("sphinx-mathjax-offline").origin).parent / "static"),
]
mathjax_path = "mathjax/tex-chtml.js"
