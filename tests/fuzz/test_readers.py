"""No damaged file shows users what they should not see, or takes long: a bounded run."""

import pytest

from tests.fuzz.test_driver import run

SEED, EXECUTIONS = 20261125, 5_970
"""Always the same files, by number and not by time; `make fuzz` draws others.  One round."""


@pytest.mark.fuzz
@pytest.mark.timeout(1200)
def test_damaged_files_of_all_formats(tmp_path):
    words = ("--seed", SEED, "--count", EXECUTIONS, "--jobs", 1, "--keep", tmp_path)
    ran = run(*words, module="fuzz")
    assert ran.returncode == 0, f"{ran.stdout}{ran.stderr}"
    assert f"{EXECUTIONS:,}" in ran.stdout
