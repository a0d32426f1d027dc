"""Scenes of the repository, and the program of the package."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import whiskmap as wm

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def cone() -> wm.Scene:
    return wm.Scene.read(ROOT / "scenes/cone.toml")


@pytest.fixture(scope="session")
def small(cone: wm.Scene) -> wm.Scene:
    return cone.replace(push_angle_deg=wm.Range(-70, 70, 24), distance_mm=wm.Range(2, 20, 16))


def program(*arguments: object, cwd: os.PathLike[str] | None = None) -> str:
    """Run the command of the package and return its standard output."""
    command = [Path(sys.executable).parent / "whiskmap", *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout
