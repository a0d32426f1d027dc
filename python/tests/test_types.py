"""Types: the stub of the extension agrees with it, and mypy accepts a sample and the package."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent


@pytest.mark.parametrize(
    "command",
    [
        ["mypy.stubtest", "whiskmap._whiskmap"],
        ["mypy", "--strict", str(HERE / "sample.py")],
        ["mypy", "--strict", "-p", "whiskmap"],
    ],
    ids=["stub", "sample", "package"],
)
def test_types_agree(command, tmp_path):
    done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
