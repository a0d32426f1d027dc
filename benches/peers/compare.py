"""Puts whiskmap's costs beside those of its peers, prints the ratios, and writes them with all they were made from.

    compare.py FOLDER PEERS.JSON        FOLDER: whiskmap.N.json, and heyoka.N.json, auto.N.json, bvp.N.json where measured,
                                        of the rounds N
"""

import json
import platform
import sys
from math import radians
from pathlib import Path

from table import lines

COMMAND = "benches/peers/run.sh"
# For each of these errors, the cheapest run of either side whose largest error is at most that.
RUNGS = (1e-4, 1e-6, 1e-8, 1e-10)
# The cheapest mesh of solve_bvp with at most this error, as a part of the contact's arclength: whiskmap's is smaller.
SOLVED = 1e-9
# The steps of whiskmap's detachment points are the cheapest with at most this error in degrees.
DETACHED = 1e-9
# What is asked of whiskmap, peer over whiskmap; of trajectories from the rung 1e-8 on.
TRAJECTORY, KERNEL, FOLD, EQUILIBRIUM, CELL = 3, 10, 300, 500, 5000
STRICT = 1e-8


def fastest(rounds):
    """The same measurements, made several times, with the smallest of each time."""
    first = rounds[0]
    if isinstance(first, dict):
        return {
            name: min(each[name] for each in rounds)
            if name.startswith("microseconds")
            else fastest([each[name] for each in rounds])
            for name in first
        }
    if isinstance(first, list):
        return [fastest(each) for each in zip(*rounds)]
    return first


def cheapest(rows, error, **wanted):
    """The row with all that is wanted and at most this error that costs least, or None."""
    rows = [row for row in rows if row["error_max"] <= error and all(row[name] == wanted[name] for name in wanted)]
    return min(rows, key=lambda row: row["microseconds"], default=None)


def ratio(peer, ours, required):
    """Two rows and their ratio, which is None where one of them is."""
    return {
        "peer_microseconds": peer and peer["microseconds"],
        "peer_error": peer and peer["error_max"],
        "whiskmap_microseconds": ours and ours["microseconds"],
        "whiskmap_error": ours and ours["error_max"],
        "ratio": peer and ours and peer["microseconds"] / ours["microseconds"],
        "required": required,
    }


def trajectories(whiskmap, heyoka):
    """heyoka, and whiskmap's scalar kernel, beside its SIMD kernel on as many threads."""
    ours = whiskmap["trajectories"]
    for threads in (1, 2):
        for rung in RUNGS if heyoka else ():
            peer = cheapest(heyoka["rows"], rung, threads=threads)
            simd = cheapest(ours, rung, kernel="simd", threads=threads)
            required = TRAJECTORY if rung <= STRICT else None
            yield f"heyoka {rung:.0e}, threads: {threads}", ratio(peer, simd, required)
    for rung in RUNGS:
        scalar, simd = (cheapest(ours, rung, kernel=kernel, threads=1) for kernel in ("scalar", "simd"))
        yield f"our scalar kernel {rung:.0e}", ratio(scalar, simd, KERNEL if rung <= STRICT else None)


def solutions(whiskmap, auto, bvp):
    """AUTO and solve_bvp beside whiskmap's detachment points and cells."""
    fold, cell = cheapest(whiskmap["detachment"], radians(DETACHED)), whiskmap["cell"]
    cell = {"microseconds": cell["microseconds"], "error_max": cell["estimate"]}
    for row in auto["rows"] if auto else ():
        ours, required = (fold, FOLD) if row["kind"] == "fold" else (cell, EQUILIBRIUM)
        yield f"AUTO {row['kind']}, NTST {row['intervals']}", ratio(row, ours, required)
    if bvp:
        yield "solve_bvp cell", ratio(cheapest(bvp["rows"], SOLVED), cell, CELL)


def main():
    folder, target = map(Path, sys.argv[1:])

    def read(name):
        rounds = [json.loads(path.read_text()) for path in sorted(folder.glob(f"{name}.*.json"))]
        return fastest(rounds) if rounds else None

    whiskmap, heyoka, auto, bvp = map(read, ("whiskmap", "heyoka", "auto", "bvp"))
    peers = {"heyoka": heyoka, "auto-07p": auto, "scipy": bvp}
    versions = {name: peer and peer["version"] for name, peer in peers.items()}
    ratios = dict([*trajectories(whiskmap, heyoka), *solutions(whiskmap, auto, bvp)])
    for line in lines(whiskmap, versions, ratios):
        print(line)
    answer = {
        "command": COMMAND,
        "machine": whiskmap["machine"],
        "versions": versions | {"python": platform.python_version()},
        "whiskmap": whiskmap,
        "heyoka": heyoka and heyoka["rows"],
        "auto": auto,
        "solve_bvp": bvp,
        "ratios": ratios,
    }
    target.write_text(json.dumps(answer, indent=1) + "\n")


if __name__ == "__main__":
    main()
