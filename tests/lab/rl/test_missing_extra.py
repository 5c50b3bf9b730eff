"""Without gymnasium the room says which extra is missing; the policy needs none."""

import subprocess
import sys

CODE = """
import sys
sys.modules["gymnasium"] = None
from drystone.errors import UsageError
from drystone.selection.policies.learned import learned
learned()
try:
    import drystone_lab.rl
except UsageError as error:
    print(error.code, error.cure)
"""


def test_says_what_to_install():
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout == "E150 Install it with `pip install 'drystone[rl]'`.\n"
