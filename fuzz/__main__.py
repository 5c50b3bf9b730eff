"""``python -m fuzz``: read damaged files of all formats, and tell what no user should see."""

import sys

from fuzz.cli import main
from fuzz.formats import FORMATS

if __name__ == "__main__":
    sys.exit(main(FORMATS))
