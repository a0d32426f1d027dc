"""What may differ, and what does."""

# Degrees, part of the length, part of the force, part of the force times the contact's distance. The first is the
# promise; AUTO's output of 11 digits and its searches leave 7e-9, 5e-11, 8e-10 and 7e-10.
TOLERANCE = {"deg": 1e-6, "mm": 1e-8, "un": 1e-6, "nnm": 1e-6}
# Below this part of E I_base / L_w^2, next to first touch, a force is compared with this part instead of itself.
FAINT_FORCE = 1e-3


def kind(column):
    """The unit that a column's name ends with."""
    return column.rsplit("_", 1)[1]


class Report:
    """One case: the worst difference of each kind, the number of points, and what is wrong."""

    def __init__(self, case):
        self.case, self.points, self.worst, self.wrong = case, 0, dict.fromkeys(TOLERANCE, 0.0), []

    def compare(self, whisker, row, columns, solution):
        """One row of the program with AUTO's solution, or with None where AUTO has none."""
        if solution is None:
            self.wrong.append(f"AUTO has no such point: {row}")
            return
        self.points += 1
        expected = whisker.observe(solution.par)
        for column in columns:
            error = abs(float(row[column]) - expected[column]) / scale(whisker, expected)[kind(column)]
            self.worst[kind(column)] = max(self.worst[kind(column)], error)
            # Not the opposite comparison: NaN must not pass.
            if not error <= TOLERANCE[kind(column)]:
                self.wrong.append(f"{column}: whiskmap {row[column]}, AUTO {expected[column]:.12g}, in {row}")

    def demand(self, condition, complaint):
        if not condition:
            self.wrong.append(complaint)

    def line(self):
        numbers = "".join(f"{error:10.1e}" for error in self.worst.values())
        return f"{self.case:36}{self.points:7}{numbers}  {'FAIL' if self.wrong else 'pass'}"


HEADER = f"{'case':36}{'points':>7}{'deg':>10}{'length':>10}{'force':>10}{'moment':>10}"


def scale(whisker, expected):
    """What the tolerances of a point are parts of."""
    force = max(expected["force_un"], FAINT_FORCE * whisker.force_un)
    return {"deg": 1.0, "mm": whisker.length_mm, "un": force, "nnm": force * expected["contact_distance_mm"]}


def must_notice(whisker, row, columns, solution):
    """Stops unless a row that is wrong by twice what may differ is found wrong, in every column."""
    expected = whisker.observe(solution.par)
    for column in columns:
        wrong = expected[column] + 2 * TOLERANCE[kind(column)] * scale(whisker, expected)[kind(column)]
        report = Report("spoiled")
        report.compare(whisker, row | {column: repr(wrong)}, [column], solution)
        if len(report.wrong) != 1:
            raise SystemExit(f"FAIL: the comparison would not notice a wrong {column}")
