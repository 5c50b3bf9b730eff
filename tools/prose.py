"""Keep what people read plain: messages of the code, the README and the pages of docs.

A fault is "is no X" for "is not an X", "stone(s)", a number without the zero before its point, and
a sentence above 25 words, where a colon ends one too.
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
MOST_WORDS = 25
FAULTS = (
    re.compile(r"(?<!here )\b(?:is|are) no (?!longer\b|more\b|data\b|\w+er\b)[a-z]\w*", re.I),
    re.compile(r"\w\(s\)"),
    re.compile(r"(?:^|[\s(=:])\.\d\w*"),
)
QUOTED = {"published.py", "classes.py", "cite.py"}
"""Modules whose texts are a licence, names, and BibTeX."""

CODE = re.compile(r"^(```|~~~).*?^\1|<!--.*?-->|`[^`\n]*`|\]\([^)]*\)", re.M | re.S)
TABLE = re.compile(r"^ *\|.*$", re.M)


def faults(text: str) -> Iterator[str]:
    """Yield what is wrong in a text."""
    for pattern in FAULTS:
        yield from (found[0].strip() for found in pattern.finditer(text))
    for sentence in re.split(r"[.:;!?](?=\s|$)|\n\s*(?:\n|[-*#>\d])", TABLE.sub("\n\n", text)):
        if (words := len(re.findall(r"\w(?:[\w'-]|\.(?=\d))*", sentence))) > MOST_WORDS:
            yield f"{words} words: {' '.join(sentence.split())[:60]}"


def messages(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the texts of a module that are not docstrings, X where something is put in."""
    said = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            said |= {id(part) for part in node.values}
            parts = (part.value if isinstance(part, ast.Constant) else "X" for part in node.values)
            yield node.lineno, "".join(map(str, parts))
        elif (
            isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in said
        ):
            yield node.lineno, node.value


def main() -> int:
    """Print faults; 1 when there are any."""
    said = list[str]()
    for path in sorted((ROOT / "src").rglob("*.py")):
        if path.name in QUOTED:
            continue
        for line, text in messages(ast.parse(path.read_text(encoding="utf-8"))):
            if " " in text:
                said += [f"{path.relative_to(ROOT)}:{line}: {fault}" for fault in faults(text)]
    for path in sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")]):
        wrong = faults(CODE.sub(" X ", path.read_text(encoding="utf-8")))
        said += [f"{path.relative_to(ROOT)}: {fault}" for fault in wrong]
    sys.stdout.write("".join(f"{line}\n" for line in said))
    return int(bool(said))


if __name__ == "__main__":
    sys.exit(main())
