"""Files of others: nothing foreign runs, nothing hangs, and every failure has a code."""

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

import drystone
from drystone.errors import DrystoneError, InputError
from drystone.io.files import file_bytes, foreign, silent_stderr
from drystone.io.images import decode
from drystone.io.json_text import DEEPEST, json_of
from drystone.io.read_stones import read_stones
from tests.io.hostile import FILES, SETTINGS, tiff_of
from tests.io.pictures import two_stones
from tests.io.test_formats import LIMIT, pillow


@pytest.fixture
def ghostscript(tmp_path, monkeypatch):
    """A program of the name of Ghostscript, first on the path; the file that it would write."""
    program, called = tmp_path / "bin" / "gs", tmp_path / "called"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\necho x > {called}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent), prepend=os.pathsep)
    return called


@pytest.mark.parametrize("name", list(FILES))
def test_files_that_are_read_or_refused(name, tmp_path, ghostscript, capfd):
    make, error = FILES[name]
    path = tmp_path / name
    path.write_bytes(make())
    try:
        said = "" if read_stones(path, settings=SETTINGS.get(name)) else "no stones"
    except DrystoneError as caught:
        said = str(caught)
    assert re.match(error or "$", said), said
    assert len(said) < 700
    assert not ghostscript.exists()
    assert capfd.readouterr() == ("", "")


def test_the_tiff_of_these_tests_can_be_read():
    for big in (False, True):
        values = decode(tiff_of(big=big), LIMIT).values
        assert values.tolist() == np.arange(24).reshape(4, 6).tolist()


@pytest.mark.parametrize("name", ["pipe.png", "pipe.json", "pipe.svg"])
def test_a_pipe_is_not_waited_for(name, tmp_path):
    os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match=r"E100 .*a pipe, and no regular file"):
        read_stones(tmp_path / name)


def test_devices_have_no_end():
    with pytest.raises(InputError, match=r"E100 .*a device, and no regular file"):
        read_stones("/dev/zero")


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    path = tmp_path / "large"
    with path.open("wb") as file:
        file.truncate(3_000_000_000)  # no byte of it is on the disk
    with pytest.raises(InputError, match=r"E100 .*it has 3000 MB, and the limit is 2000 MB"):
        read_stones(path)
    path.with_name("small").write_bytes(b"abc")
    assert file_bytes(path.with_name("small"), 3) == b"abc"


@pytest.mark.parametrize(
    "raised", [RecursionError, ZeroDivisionError("x" * 999), AttributeError("a"), KeyError, OSError]
)
def test_whatever_a_decoder_raises_has_a_code(raised):
    with (
        pytest.raises(InputError, match="E106 a: damaged") as caught,
        foreign(lambda why: InputError("E106", f"damaged ({why})", where="a")),
    ):
        raise raised
    assert len(str(caught.value)) < 300


def test_a_memory_that_is_too_small_is_said():
    with (
        pytest.raises(InputError, match="E110 a: there is not enough memory"),
        foreign(lambda why: InputError("E106", why, where="a")),
    ):
        raise MemoryError


def test_errors_with_a_code_and_interrupts_stay_as_they_are():
    own = InputError("E110", "too large")
    for raised in (own, KeyboardInterrupt()):
        with pytest.raises(type(raised)) as caught, foreign(lambda why: InputError("E106", why)):
            raise raised
        assert caught.value is raised


def test_what_libraries_print_reaches_nobody(capfd):
    data = bytearray(pillow(two_stones(7, 9, np.uint8), "TIFF", compression="tiff_lzw"))
    data[8:60] = bytes(52)  # libtiff says so in C
    with pytest.raises(InputError, match="E10"):
        decode(bytes(data), LIMIT)
    with silent_stderr():
        os.write(2, b"noise")
    os.write(2, b"heard")
    assert capfd.readouterr() == ("", "heard")


def test_json_may_be_nested_as_deep_as_whoever_reads_it_may_recurse():
    assert json_of("[" * DEEPEST + "]" * DEEPEST) is not None
    with pytest.raises(ValueError, match="deeper than 100"):
        json_of("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1))
    text = json.dumps(["[{" * DEEPEST + '\\"' + "[" * DEEPEST] * 2)
    assert json_of(text) == json.loads(text)  # brackets in strings do not count


def test_only_one_module_opens_pictures_and_none_follows_series():
    for path in Path(drystone.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        # The linter sees the names that it bans, and not what a file of tifffile is asked for.
        assert "Image.open(" not in text.replace("``Image.open``", ""), path
        assert "tifffile" not in text or ".series" not in text.replace("`.series`", ""), path
