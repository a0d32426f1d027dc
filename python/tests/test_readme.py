"""README's block of Python after README's installation, in a fresh environment, and missing extras."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import venv
from pathlib import Path

import pytest
from conftest import ROOT

README = (ROOT / "README.md").read_text()


def block(language: str, around: str) -> str:
    """Return the block of README with this text."""
    [found] = (text for text in re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL) if around in text)
    return found


def test_the_block_of_the_readme_runs_after_its_installation(tmp_path):
    wheel = os.environ.get("WHISKMAP_WHEEL")
    if wheel is None:
        pytest.skip("WHISKMAP_WHEEL is not set; python/tests/run.sh sets it")
    # The wheel that was built, in place of one from the folder.
    command = block("sh", "pip install").strip()
    extras = re.fullmatch(r"pip install '?\./python(\[[\w,]+\])?'?", command)
    assert extras, command
    venv.create(tmp_path / "fresh", with_pip=True)
    python = tmp_path / "fresh" / ("Scripts" if os.name == "nt" else "bin") / "python"
    install = [python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-compile", wheel + (extras[1] or "")]
    subprocess.run(install, check=True)
    code = block("python", "import whiskmap as wm")
    environment = os.environ | {"MPLBACKEND": "Agg"}
    done = subprocess.run([python, "-W", "error", "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


MISSING = {
    "plot": ("matplotlib", "wm.plot.regimes"),
    "lazy": ("dask", "wm.open(path, chunks={})"),
    "progress": ("tqdm", "wm.map(cone, progress=True)"),
}


@pytest.mark.parametrize("extra", MISSING)
def test_a_missing_extra_is_named(extra):
    module, call = MISSING[extra]
    code = f"""
import sys, whiskmap as wm
sys.modules["{module}"] = None
path = "nowhere.exr"
cone = wm.Scene.read("scenes/cone.toml").replace(push_angle_deg=[0, 1], distance_mm=[9])
try:
    {call}
except ImportError as why:
    print(why)
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert f"{module} is missing: install the extra `{extra}`" in done.stdout, (done.stdout, done.stderr)


def test_every_extra_is_one_of_the_package():
    project = (ROOT / "python/pyproject.toml").read_text()
    assert all(f"\n{extra} = [" in project for extra in MISSING)


def test_the_examples_run_on_their_own():
    script = (ROOT / "python/examples/run.sh").read_text()
    assert "install.sh" in script and "run python/tests/run.sh first" not in script
    assert os.access(Path(ROOT, "python/install.sh"), os.X_OK)
