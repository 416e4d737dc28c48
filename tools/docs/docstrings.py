#!/usr/bin/env python3
"""Copies headers, with their comments turned into those that Doxygen reads: docstrings.py FOLDER COPY

A comment at the head of the file describes the file, one above a declaration or behind it describes that, and what stands
indented below a sentence is a formula or an example, which keeps its lines.
"""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import re
import sys

TAG = re.compile(r"@(param|return|throw|pre|post|note)\b")


def is_comment(line):
    return line.lstrip().startswith("//")


def head_of(lines):
    """Returns the comment at the head as one on the file, and what is left."""
    count = 0
    while count < len(lines) and is_comment(lines[count]):
        count += 1
    text = [line.lstrip()[2:] for line in lines[:count] if "SPDX-License-Identifier" not in line]
    return ["/// @file"] + block(["///" + line for line in text]), lines[count:]


def block(comment):
    """Keeps the lines of what is indented in one comment of `///` lines."""
    out, verbatim, in_tag = [], False, False
    for line in comment:
        indent = re.match(r"\s*", line).group()
        text = line.lstrip()[3:]
        text = text[1:] if text.startswith(" ") else text
        tagged = TAG.match(text) is not None
        deep = text.startswith("  ")
        if tagged:
            in_tag = True
        elif not deep:
            in_tag = False
        wanted = deep and not in_tag
        if wanted != verbatim and text.strip():
            out.append(indent + ("/// @code{.unparsed}" if wanted else "/// @endcode"))
            verbatim = wanted
        # What a comment quotes, such as \\n, is no command of Doxygen.
        out.append(indent + "/// " + (text if verbatim else text.replace("\\", "\\\\")))
    if verbatim:
        out.append(re.match(r"\s*", comment[-1]).group() + "/// @endcode")
    return out


def is_divider(line):
    return re.match(r"\s*// ---", line) is not None


def convert(lines):
    head, lines = head_of(lines)
    out = list(head)
    at = 0
    column = None  # of a comment behind a declaration that goes on below
    while at < len(lines):
        line = lines[at]
        if is_comment(line) and column is not None and line.index("//") == column:
            out.append(line.replace("//", "///<", 1))
            at += 1
            continue
        column = None
        if is_comment(line) and not is_divider(line):
            comment = []
            while at < len(lines) and is_comment(lines[at]) and not is_divider(lines[at]):
                text = lines[at]
                comment.append(text if text.lstrip().startswith("///") else text.replace("//", "///", 1))
                at += 1
            out += block(comment)
            continue
        if line.lstrip().startswith("friend "):
            # It is declared again, with a comment, where users see it.
            line = ""
        behind = re.match(r'^(\s*[^/"#\s][^"#]*?[;,{}\w)])\s+//(?!/) ?(.*)$', line)
        if behind and not line.lstrip().startswith("}") and not line.lstrip().startswith("namespace"):
            if behind.group(1).rstrip()[-1] in ";,}" or re.search(r"\w$", behind.group(1)):
                column = line.index("//")
                line = behind.group(1) + "  ///< " + behind.group(2)
        out.append(line)
        at += 1
    return out


def main():
    folder, copy = (pathlib.Path(name) for name in sys.argv[1:])
    for header in sorted(folder.rglob("*.h")):
        target = copy / header.relative_to(folder)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("\n".join(convert(header.read_text(encoding="utf-8").split("\n"))), encoding="utf-8")


if __name__ == "__main__":
    main()
