"""Files of whisker trackers."""

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT

import whiskmap as wm
from test_motion import same, table

FILM = ROOT / "scenes/deeplabcut.csv"
ROWS = ROOT / "scenes/measurements.csv"
POLE = {"pole": "pole", "contact_within_mm": 0.35}
SCALE = {"mm_per_pixel": 0.05, "fps": 500}


def test_frames_are_those_of_the_program_and_of_force(cone, tmp_path):
    found = wm.read_tracking(FILM, **SCALE, **POLE, curvature_at_mm=2)
    assert found.format == "deeplabcut" and found.frames.sizes == {"time_s": 56}
    options = ["--pole", "pole", "--contact-within", "0.35", "--mm-per-pixel", "0.05", "--fps", "500", "--curvature-at", "2"]
    rows = table("import", str(FILM), *options)
    same(found.frames, rows)
    assert any("56 frames are gaps" in note for note in found.notes)
    with pytest.warns(wm.SceneWarning, match="of 56 frames have no force"):
        force = wm.force(cone, found.frames, model=True)
    assert (force.reason == "missing").sum() == 3 and force.attrs["baseline_frames"] > 10
    assert float(force.force_un.max()) > 1
    with pytest.warns(wm.SceneWarning, match="missing angles: 3"):
        whisk = wm.whisk(cone, 15.66, found.frames.time_s, found.frames.angle_deg, bridge_s=0.01)
    assert "slip-off" in whisk.events.event.values


@pytest.mark.filterwarnings("ignore::whiskmap.SceneWarning")
def test_the_example_of_the_page_runs(cone, monkeypatch):
    page = (ROOT / "docs/python.md").read_text()
    [example] = (block.split("```")[0] for block in page.split("```python\n")[1:] if "read_tracking" in block.split("```")[0])
    monkeypatch.chdir(ROOT)
    names = {"wm": wm, "scene": cone}
    exec(example, names)
    assert abs(names["traced"].whisker.length_mm - 20) < 0.1


def test_a_given_taper_is_that_of_the_rod():
    found, given = (wm.read_tracking(FILM, **SCALE, **POLE, taper=taper) for taper in (None, 0.95))
    assert any("the taper is 0.9" in note for note in found.notes)
    assert not any("the taper is" in note for note in given.notes)
    assert 1e-4 < abs(found.frames.angle_deg - given.frames.angle_deg).max() < 0.5


def test_detachments_are_those_of_fit(cone):
    found = wm.read_tracking(str(FILM), **SCALE, **POLE).detachments
    assert found.side.values.tolist() == ["cb"] and abs(found.distance_mm.item() - 15.66) < 0.1
    points = {name: np.repeat(found[name].values, 2) for name in ("side", "distance_mm", "push_angle_deg")}
    fitted = wm.fit(cone, points, ["tip_radius_um"])
    assert abs(fitted.points.residual_deg.values).max() < 0.1
    free = wm.read_tracking(FILM, **SCALE, points=["base", "w2", "w3", "w5", "w7", "tip"])
    with pytest.raises(ValueError, match="^detachments: pole and contact_within_mm must be given to read_tracking"):
        free.detachments


def test_results_can_be_pickled():
    for film in (wm.read_tracking(FILM, **SCALE, **POLE), wm.read_tracking(ROWS, **SCALE)):
        again = pickle.loads(pickle.dumps(film))
        xr.testing.assert_identical(again.frames, film.frames)
        assert again.notes == film.notes and again.format == film.format
        assert "_points" not in repr(film)
    film = wm.read_tracking(FILM, **SCALE, **POLE)
    again = pickle.loads(pickle.dumps(film))
    xr.testing.assert_identical(again.detachments, film.detachments)
    np.testing.assert_array_equal(again.shape(2), film.shape(2))


def test_a_shape_is_the_rest_points_of_a_whisker():
    found = wm.read_tracking(FILM, **SCALE, **POLE)
    points = found.shape(2)
    assert points.shape == (14, 2)
    whisker = wm.Whisker(base_radius_um=30, tip_radius_um=1.5, youngs_modulus_gpa=3, rest_points=points)
    scene = wm.Scene(whisker=whisker, grid=wm.Grid(push_angle_deg=[10], distance_mm=[15]))
    assert abs(scene.whisker.length_mm - 20) < 0.1
    with pytest.raises(ValueError, match="^frame = 4: must be a frame with a whisker: this one is a gap"):
        found.shape(4)
    with pytest.raises(TypeError, match="^frame = 1.5: must be a whole number"):
        found.shape(1.5)
    for frame in (-1, 56, 10**30):
        with pytest.raises(ValueError, match=f"^frame = {frame}: must be between 0 and 55, the numbers of the frames"):
            found.shape(frame)
    with pytest.raises(wm.SceneError, match="must be in mm: the curve through them is 399.849 mm long"):
        scene.replace(rest_points=points / 0.05, length_mm=None)


def test_measurements_come_as_csv_and_as_nwb(tmp_path):
    found = wm.read_tracking(ROWS, **SCALE)
    assert found.format == "whisk" and found.frames.reason.values[25] == "missing"
    with pytest.raises(ValueError, match="^frame = 3: has no points: measurements of whisk are without points along the whisker"):
        found.shape(3)
    pynwb, ndx_whisk = pytest.importorskip("pynwb"), pytest.importorskip("ndx_whisk")
    from datetime import datetime, timezone

    columns = np.genfromtxt(ROWS, delimiter=",", names=True)
    names = {"fid": "frame_id", "wid": "whisker_id"}
    # The extension has no identity -1.
    kept = columns[columns["label"] >= 0]
    rows = ndx_whisk.WhiskerMeasurementTable(name="whiskers", description="made up")
    kinds = {"frame_id": np.uint32, "whisker_id": np.uint16, "label": np.uint16, "face_x": np.int32, "face_y": np.int32}
    for row in kept:
        cells = {names.get(name, name): row[name] for name in columns.dtype.names}
        rows.add_row({name: kinds.get(name, np.float32)(value) for name, value in cells.items()})
    file = pynwb.NWBFile(session_description="made up", identifier="1", session_start_time=datetime(2020, 1, 1, tzinfo=timezone.utc))
    file.create_processing_module(name="behavior", description="whiskers").add(rows)
    path = tmp_path / "film.nwb"
    with pynwb.NWBHDF5IO(str(path), mode="w") as io:
        io.write(file)
    stored = wm.read_tracking(path, **SCALE)
    assert stored.format == "whisk"
    for name in ("angle_deg", "curvature_per_mm", "length_mm"):
        np.testing.assert_allclose(stored.frames[name], found.frames[name], rtol=1e-4, atol=1e-3)


def test_an_nwb_file_names_its_extra(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "ndx_whisk", None)
    path = tmp_path / "film.nwb"
    path.write_bytes(b"\x89HDF\r\n\x1a\nmore")
    with pytest.raises(ImportError, match="install the extra `nwb` of whiskmap"):
        wm.read_tracking(path, **SCALE)


def test_bad_values_are_refused(tmp_path):
    for options, kind, why in [
        ({"mm_per_pixel": 0}, ValueError, "mm_per_pixel = 0: must be a number between 1e-9 and 1e9"),
        ({"format": "csv"}, ValueError, "format = 'csv': must be one of 'deeplabcut', 'whisk', 'xy'"),
        ({"face_axis": "z"}, ValueError, "face_axis = 'z': must be one of 'x', 'y'"),
        ({"pole": [1]}, ValueError, "pole: must be x and y in pixels, has 1 numbers"),
        ({"points": "base"}, TypeError, "points = 'base': must be a list of names"),
        ({"whisker": 1.5}, TypeError, "whisker = 1.5: must be a whole number"),
        ({"whisker": True}, TypeError, "whisker = True: must be a whole number"),
        ({"degree": -1}, ValueError, "degree = -1: must be between 0 and 6"),
        ({"fps": "500"}, TypeError, "fps = '500': must be a number, without a unit"),
    ]:
        with pytest.raises(kind) as refused:
            wm.read_tracking(FILM, **{**SCALE, **options})
        assert why in str(refused.value)
    with pytest.raises(OSError):
        wm.read_tracking(tmp_path / "no.csv", **SCALE)


def test_a_distance_in_contact_that_is_too_small_warns():
    with pytest.warns(wm.SceneWarning, match="more than 0.1 mm: check `contact_within_mm`, the pole's position, `taper` and `mm_per_pixel`"):
        wm.read_tracking(FILM, **SCALE, pole="pole", contact_within_mm=0.1)


def test_messages_name_the_options_of_the_caller():
    """Python has arguments; the program has flags."""
    with pytest.warns(wm.SceneWarning, match="give the parts along the whisker by `points`, and the pole by `pole`"):
        found = wm.read_tracking(FILM, **SCALE)
    command = [Path(sys.executable).parent / "whiskmap", "import", FILM, "--mm-per-pixel", "0.05", "--fps", "500"]
    printed = subprocess.run(command, capture_output=True, text=True).stderr
    assert "give the parts along the whisker by --points, and the pole by --pole" in printed and "`" not in printed
    assert not any("--" in note for note in found.notes)
