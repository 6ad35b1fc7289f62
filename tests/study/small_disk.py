"""`python small_disk.py KIND FILE SIZE...`: a sweep on a disk too small for it, then with room.

KIND: tmpfs, a disk of SIZE bytes that is mounted in a namespace of this process's own (see
NAMESPACE); file, where no file may have more than SIZE bytes. Prints a line of JSON for each size:
what the first try ended with (code, said), the keys of the cases noted then, and what the same
command ended with once there was room (again, then). The second leaves its directory in SIZE.
"""

import json
import resource
import shutil
import subprocess
import sys
from pathlib import Path

from porolub.study import sweep as module
from tests.study.drills import journal, sweep

NAMESPACE = ["unshare", "--map-root-user", "--mount"]
"""In front of the command: one may mount there, without being root where the kernel allows it."""
DRAWN = 50_000  # bytes from which on there are figures, which take their time
plot_sweep = module.plot_sweep


def may_mount() -> bool:
    """Return whether there can be a tmpfs here: not in all containers."""
    trial = [*NAMESPACE, "mount", "-t", "tmpfs", "tmpfs", "/mnt"]
    try:
        return subprocess.run(trial, capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        return False


def mount(disk: Path, options: str) -> None:
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(disk)], check=True)


def limit(size: int) -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def main(kind: str, file: Path, sizes: list[int]) -> None:
    disk = Path("disk")
    for size in sizes:
        module.plot_sweep = plot_sweep if size >= DRAWN else lambda directory: []
        disk.mkdir(exist_ok=True)
        if kind == "tmpfs":
            mount(disk, f"size={size}")
        else:
            limit(size)
        first = sweep(file, disk / "here")
        noted = [row["key"] for row in journal(disk / "here")]
        if kind == "tmpfs":
            mount(disk, "remount,size=20m")
        else:
            limit(resource.RLIM_INFINITY)
        second = sweep(file, disk / "here")
        shutil.copytree(disk / "here", str(size))
        shutil.rmtree(disk / "here")
        if kind == "tmpfs":
            subprocess.run(["umount", str(disk)], check=True)
        found = {"code": first.exit_code, "said": first.output, "noted": noted,
                 "again": second.exit_code, "then": second.output}  # fmt: skip
        print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), [int(size) for size in sys.argv[3:]])
