"""Contacts from moment and force at the base."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import whiskmap as wm
from test_motion import CONE, same, table


@pytest.fixture
def readings(cone):
    states = [wm.shape(cone, 12.0, push, points=3).attrs for push in (-20.0, 5.0, 10.0)]
    return pd.DataFrame({name: [state[name] for state in states] for name in ("base_moment_nnm", "base_force_y_un")})


def test_the_rows_are_those_of_the_program(cone, readings, tmp_path):
    readings = readings.assign(angle_deg=30.0)
    path = tmp_path / "readings.csv"
    readings.to_csv(path, index=False)
    expected = table("locate", CONE, "--readings", path, "--moment-sd", "1nNm", "--force-sd", "0.1uN")
    for given in (path, readings, {name: list(readings[name]) for name in readings}):
        found = wm.locate(cone, given, moment_sd_nnm=1, force_sd_un=0.1)
        same(found, expected)
    assert np.isfinite(found.lab_contact_x_mm).all() and found.distance_mm.attrs["units"] == "mm"


def test_missing_numbers_keep_their_place(cone, readings):
    readings.loc[1] = np.nan
    with pytest.warns(wm.SceneWarning, match="1 of 3 readings have no state"):
        found = wm.locate(cone, readings)
    missing = found.isel(number=np.flatnonzero(found.reading.values == 2))
    assert missing.reason.values.tolist() == ["incomplete"] and np.isnan(missing.distance_mm.values).all()


def test_one_reading_may_be_numbers(cone, readings):
    one = {name: float(readings[name][1]) for name in readings}
    xr.testing.assert_identical(wm.locate(cone, one), wm.locate(cone, {name: [value] for name, value in one.items()}))


def test_every_missing_number_is_a_gap(cone, readings):
    for missing in (None, np.nan, pd.NA, pd.NaT, np.datetime64("NaT"), np.ma.masked):
        given = {name: [values[0], missing, values[2]] for name, values in readings.items()}
        with pytest.warns(wm.SceneWarning, match="1 of 3 readings have no state"):
            assert "incomplete" in wm.locate(cone, given).reason.values
    masked = {name: np.ma.masked_array(values, [False, True, False]) for name, values in readings.items()}
    with pytest.warns(wm.SceneWarning, match="1 of 3 readings have no state"):
        assert "incomplete" in wm.locate(cone, masked).reason.values


def test_bad_readings_are_refused(cone, readings):
    with pytest.raises(ValueError, match="must have at least two of the columns base_moment_nnm"):
        wm.locate(cone, readings[["base_moment_nnm"]])
    with pytest.raises(ValueError, match=r"readings\[1\]: base_moment_nnm = 1e\+?20: must be a number between -1e18 and 1e18"):
        wm.locate(cone, {"base_moment_nnm": [1.0, 1e20], "base_force_y_un": [1.0, 1.0]})
    with pytest.raises(ValueError, match="must both be given, or none"):
        wm.locate(cone, readings, moment_sd_nnm=1)
    with pytest.raises(ValueError, match="force_sd_un = 0.0: must be more than 0"):
        wm.locate(cone, readings, moment_sd_nnm=1, force_sd_un=0)
    with pytest.raises(ValueError, match="friction = 0.1: must be 0"):
        wm.locate(cone.replace(friction=0.1), readings)
    with pytest.raises(TypeError, match="readings = 3"):
        wm.locate(cone, 3)
