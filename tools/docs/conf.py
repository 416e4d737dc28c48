# How Sphinx makes the pages; tools/docs/stage.cmake puts them where it finds them.
# SPDX-License-Identifier: Apache-2.0
import os

project = "Umbrick"
author = "The authors of Umbrick"
release = os.environ["UMBRICK_VERSION"]
extensions = ["myst_parser"]
root_doc = "index"
myst_heading_anchors = 4
html_theme = "furo"
html_title = f"Umbrick {release}"
html_show_copyright = False
# The pages are Markdown as it is read beside the code, whose READMEs begin at any level of heading.
suppress_warnings = ["myst.header"]
# Blocks of a shell and of what a program prints are quoted as they are.
highlight_language = "none"
# The pages of the library are Doxygen's.
html_extra_path = ["../extra"]
