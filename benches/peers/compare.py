"""Compares the costs of whiskmap and its peers: prints the ratios, and writes them with the measurements.

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
# Error bounds. For each, the cheapest run within the bound is compared, for whiskmap and for the peer.
RUNGS = (1e-4, 1e-6, 1e-8, 1e-10)
# Largest error of the mesh of solve_bvp, relative to the contact's arclength; the error of whiskmap is smaller.
SOLVED = 1e-9
# Largest error of whiskmap's detachment points, in degrees.
DETACHED = 1e-9
# Required ratios of costs, peer over whiskmap; for trajectories only at errors of at most STRICT.
TRAJECTORY, KERNEL, FOLD, EQUILIBRIUM, CELL = 3, 10, 300, 500, 5000
STRICT = 1e-8


def fastest(rounds):
    """Returns the measurements of one round, each time replaced by the smallest of all rounds."""
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
    """Returns the cheapest row with the values of `wanted` and an error of at most `error`, or None."""
    rows = [row for row in rows if row["error_max"] <= error and all(row[name] == wanted[name] for name in wanted)]
    return min(rows, key=lambda row: row["microseconds"], default=None)


def ratio(peer, ours, required):
    """Returns the costs and errors of two rows, and the ratio of their costs; None if a row is None."""
    return {
        "peer_microseconds": peer and peer["microseconds"],
        "peer_error": peer and peer["error_max"],
        "whiskmap_microseconds": ours and ours["microseconds"],
        "whiskmap_error": ours and ours["error_max"],
        "ratio": peer and ours and peer["microseconds"] / ours["microseconds"],
        "required": required,
    }


def trajectories(whiskmap, heyoka):
    """Yields ratios of heyoka and of whiskmap's scalar kernel to its SIMD kernel on as many threads."""
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
    """Yields ratios of AUTO and solve_bvp to whiskmap's detachment points and cells."""
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
    report = {
        "command": COMMAND,
        "machine": whiskmap["machine"],
        "versions": versions | {"python": platform.python_version()},
        "whiskmap": whiskmap,
        "heyoka": heyoka and heyoka["rows"],
        "auto": auto,
        "solve_bvp": bvp,
        "ratios": ratios,
    }
    target.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
