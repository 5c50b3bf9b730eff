"""Print how large the code is, by rooms, and fail above the limits."""

import ast
import io
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
LIMITS = {"src/drystone": 57_403, "src/drystone_lab": 9_853, "tests": 41_204}
"""Most lines of each; lower them when the code shrinks, never raise them without a reason."""


def lines_of(path: Path) -> tuple[int, int]:
    """Return all lines of a file, and those that are code: no blank, comment or docstring."""
    text = path.read_text(encoding="utf-8")
    count = text.count("\n")
    if path.suffix != ".py":
        plain = (line.strip() for line in text.splitlines())
        return count, sum(bool(line) and not line.startswith("#") for line in plain)
    said = set(_docstring_lines(ast.parse(text)))
    code = set[int]()
    idle = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in idle and token.type != tokenize.ENDMARKER:
            code |= set(range(token.start[0], token.end[0] + 1))
    return count, len(code - said)


def _docstring_lines(tree: ast.Module) -> Iterator[int]:
    """Yield the lines of texts that stand alone."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield from range(node.lineno, (node.end_lineno or node.lineno) + 1)


def main() -> int:
    """Print the table; 1 when a part is larger than it may be."""
    whole, larger = [0, 0], False
    for name, most in LIMITS.items():
        rooms: dict[str, list[int]] = {}
        for path in sorted((ROOT / name).rglob("*")):
            if path.suffix not in {".py", ".pyx", ".pxd"}:
                continue
            parts = path.relative_to(ROOT / name).parts
            room = rooms.setdefault(parts[0] if len(parts) > 1 else "-", [0, 0])
            for which, lines in enumerate(lines_of(path)):
                room[which] += lines
        total = [sum(room[which] for room in rooms.values()) for which in (0, 1)]
        if "--rooms" in sys.argv:
            for room_name, (lines, code) in sorted(rooms.items(), key=lambda one: -one[1][0]):
                sys.stdout.write(f"  {room_name:16} {lines:6,} lines, {code:6,} of code\n")
        sys.stdout.write(
            f"{name:16} {total[0]:6,} lines, {total[1]:6,} of code (at most {most:,} lines)\n"
        )
        larger |= total[0] > most
        if name != "tests":
            whole = [a + b for a, b in zip(whole, total, strict=True)]
    sys.stdout.write(f"{'package and lab':16} {whole[0]:6,} lines, {whole[1]:6,} of code\n")
    if larger:
        sys.stdout.write(
            "A part is larger than it may be: what can go? (tools/size.py has the limits)\n"
        )
    return int(larger)


if __name__ == "__main__":
    sys.exit(main())
