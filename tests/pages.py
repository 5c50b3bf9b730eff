"""What the documents print."""

import re
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1] / "docs"


def printed(page, kind, section=None):
    """Return the blocks of a kind on a page of the documents, or in one of its sections."""
    text = (DOCS / page).read_text(encoding="utf-8")
    if section is not None:
        text = text.split(f"## {section}\n")[1].split("\n## ")[0]
    return re.findall(rf"^ *```{kind}\n(.*?)^ *```$", text, re.MULTILINE | re.DOTALL)
