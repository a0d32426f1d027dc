"""The ratios as a table of 80 columns."""

NOTES = """\
Microseconds each, of the fastest run, and the largest error. Both sides of a
line with an error in its name: the cheapest setting whose largest error is at
most that. heyoka: one trajectory with first derivatives; compilation and
Python's loop not counted.
AUTO: one point by mesh size (NTST), error in radians of a push angle of which
it prints 11 digits.
solve_bvp: one cell, the cheapest mesh with an error of at most 1e-9 of the
contact's arclength. whiskmap beside them: a detachment point in the cheapest
steps with an error of at most 1e-9 degrees (the error is in radians), or a cell
of a map in those for 1e-9 radians, refined to 1e-12, with the estimated error.
AUTO, solve_bvp, these two: one thread."""


def lines(whiskmap, versions, ratios):
    yield f"{whiskmap['machine']}, {whiskmap['unit']}"
    for name, version in versions.items():
        yield f"{name} {version}" if version else f"{name} is NOT measured here"
    yield ""
    yield f"{'':26}{'peer':>17}{'whiskmap':>17}{'ratio':>8}{'goal':>6}"
    for name, each in ratios.items():
        sides = "".join(
            number(each[f"{side}_microseconds"], "9.4g") + number(each[f"{side}_error"], "8.0e")
            for side in ("peer", "whiskmap")
        )
        goal, verdict = "", ""
        if each["required"] is not None and each["ratio"] is not None:
            goal, verdict = each["required"], "met" if each["ratio"] >= each["required"] else "short"
        yield f"{name:26}{sides}{number(each['ratio'], '8.4g')}{goal:>6} {verdict}".rstrip()
    yield ""
    yield from NOTES.splitlines()


def number(value, form):
    """Formats `value`, or a dash for None."""
    return f"{value:{form}}" if value is not None else f"{'-':>{form.split('.')[0]}}"
