"""Joins the page of `whiskmap explore` from its sources and the solver: assemble.py SOLVER.wasm OUTPUT.html."""

import base64
import hashlib
import json
import re
import sys
import zlib
from pathlib import Path

WEB = Path(__file__).parent
ROOT = WEB.parents[1]

# Each module after those that it imports.
MODULES = "dom state text link field colours plot solver compute whisker whisk charts controls readout points files map main".split()

# A comma or a blank more would change the hash of a script, and the browser would refuse it.
IMPORT = re.compile(r"^import \{ (.*) \} from '\./(\w+)\.js';$", re.MULTILINE)
EXPORT = re.compile(r"^export (?:async )?(?:const|function|class) (\w+)", re.MULTILINE)


def scope(name: str) -> str:
    """A module as a function that returns what it exports; the last one waits at its top, and stays as it is."""
    text = (WEB / "page" / f"{name}.js").read_text()
    exports = ", ".join(EXPORT.findall(text))
    text = IMPORT.sub(r"const { \1 } = $\2;", text)
    text = re.sub(r"^export ", "", text, flags=re.MULTILINE)
    return text if name == MODULES[-1] else f"const ${name} = (() => {{\n{text}return {{ {exports} }};\n}})();\n"


def sources() -> str:
    """Hash of what the page is made of, but for the library: FNV-1a of 64 bits over names and contents (see tests/explore.rs)."""
    folders = [WEB / "page", WEB / "src"]
    files = [file for folder in folders for file in folder.iterdir()]
    files += [WEB / "assemble.py", WEB / "build.sh", ROOT / "scenes" / "cone.toml"]
    number = 0xCBF29CE484222325
    for file in sorted(file.relative_to(ROOT).as_posix() for file in files):
        for byte in file.encode() + b"\0" + (ROOT / file).read_bytes() + b"\0":
            number = ((number ^ byte) * 0x100000001B3) % 2**64
    return f"{number:016x}"


def digest(text: str) -> str:
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def main(solver: str, output: str) -> None:
    script = "".join(scope(name) for name in MODULES)
    style = (WEB / "page" / "style.css").read_text()
    manifest = (ROOT / "Cargo.toml").read_text()
    policy = {
        "default-src": "'none'",
        "script-src": f"{digest(script)} 'wasm-unsafe-eval'",
        "style-src": digest(style),
        "img-src": "data:",
        "worker-src": "blob:",
        "connect-src": "'none'",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    scene = {"text": (ROOT / "scenes" / "cone.toml").read_text(), "origin": "cone.toml"}
    parts = {
        "policy": "; ".join(f"{name} {value}" for name, value in policy.items()),
        "sources": sources(),
        "version": re.search(r'^version = "(.*)"', manifest, re.MULTILINE)[1],
        "style": style,
        "start": json.dumps({"scene": scene, "points": None}).replace("<", "\\u003c"),
        "worker": (WEB / "page" / "worker.js").read_text(),
        "wasm": base64.b64encode(zlib.compress(Path(solver).read_bytes(), 9)).decode(),
        "script": script,
    }
    page = (WEB / "page" / "index.html").read_text()
    page = re.sub(r"\{\{(\w+)\}\}", lambda part: parts[part[1]], page)
    Path(output).write_text(page)
    print(f"{output}: {len(page.encode()) / 1e6:.2f} MB, solver {Path(solver).stat().st_size / 1e6:.2f} MB")


main(*sys.argv[1:])
