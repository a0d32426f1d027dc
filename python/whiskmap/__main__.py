"""The command `whiskmap`, also as `python -m whiskmap`."""

from __future__ import annotations

import os
import sys

from whiskmap._whiskmap import run_command


def main() -> int:
    """Run the command line of this process and return the exit code."""
    # Vulkan drivers print an error without an absolute path, as in the program.
    if not os.path.isabs(os.environ.get("XDG_RUNTIME_DIR", "")):
        os.environ["XDG_RUNTIME_DIR"] = "/"
    return run_command(["whiskmap", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
