"""Wraps long lines of a help text from standard input, each below where its description begins."""
# SPDX-License-Identifier: Apache-2.0
import sys
import textwrap

WIDTH, COLUMN = 104, 30  # of a page, and of descriptions

for line in sys.stdin.read().splitlines():
    described = line.startswith("  ") and len(line) > COLUMN and line[COLUMN - 1] == " " and line[COLUMN] != " "
    head, text = (line[:COLUMN], line[COLUMN:]) if described else ("", line)
    print(textwrap.fill(text, WIDTH, initial_indent=head, subsequent_indent=" " * len(head), break_on_hyphens=False)
          if len(line) > WIDTH else line)
