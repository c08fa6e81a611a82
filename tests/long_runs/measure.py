"""Runs each system on logs of 10 minutes, 1 hour and 8 hours, prints time, memory and output, and writes them into docs/performance.md.

    cargo build --release -p wayfix
    python3 tests/long_runs/measure.py target/release/wayfix      # PyPI mcap, mcap-protobuf-support
"""

import argparse
import os
import re
import subprocess
import tempfile
import time
from pathlib import Path

import long_log

HOURS = ("10 min", 1 / 6), ("1 h", 1.0), ("8 h", 8.0)
ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "fixtures"
PAGE = ROOT / "docs" / "performance.md"
INIT = (FIXTURES / "film_head.txt").read_text().split()[0]
BEGIN, END = "<!-- long runs -->\n", "<!-- end long runs -->"
# Name, and stored log, options and hours at most: images take long.
RUNS = {
    "slam, points": ("loop_known", ["slam"], 8),
    "slam, laser": ("office_laser", ["slam"], 8),
    "lines": ("office_laser", ["lines"], 8),
    "cml": ("store_area", ["cml"], 8),
    "color": ("color_bright", ["color", "--map", str(FIXTURES / "four-legged-field.toml")], 1 / 6),
    "track": ("film_head", ["track", "--init", INIT], 1 / 6),
}
MEGABYTE = 1e6


def run(program, options, log, out):
    """CPU time in s, peak memory in MB (sampled) and output in MB."""
    command = [program, "run", *options, "--log", str(log), "--out", str(out)]
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    ended, peak = 0, 0
    while not ended:
        found = re.search(r"VmHWM:\s*(\d+) kB", Path(f"/proc/{child.pid}/status").read_text())
        peak = max(peak, int(found[1]) if found else 0)
        time.sleep(0.01)
        ended, status, usage = os.wait4(child.pid, os.WNOHANG)
    if status != 0:
        raise SystemExit(f"{' '.join(command)} failed")
    written = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
    return usage.ru_utime + usage.ru_stime, peak * 1024 / MEGABYTE, written / MEGABYTE


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program wayfix")
    parser.add_argument("--only", default="", help="runs with this in their name; the page stays as it is")
    parser.add_argument("--hours", type=float, default=8, help="the longest log; below 8 the page stays as it is")
    arguments = parser.parse_args()
    rows = ["| run | log | MB | CPU time | peak memory, MB | output, MB |", "| --- | --- | ---: | ---: | ---: | ---: |"]
    for name, (stored, options, most) in RUNS.items():
        for length, hours in HOURS:
            if arguments.only not in name or hours > min(most, arguments.hours):
                continue
            with tempfile.TemporaryDirectory() as folder:
                log, out = Path(folder, "long.mcap"), Path(folder, "out")
                long_log.write(FIXTURES / f"{stored}.mcap", log, 3600 * hours)
                seconds, memory, output = run(arguments.program, options, log, out)
                size = log.stat().st_size / MEGABYTE
            rows.append(f"| {name} | {length} | {size:.0f} | {seconds:.0f} s | {memory:.0f} | {output:.0f} |")
            print(rows[-1], flush=True)
    if not arguments.only and arguments.hours >= 8:
        before, rest = PAGE.read_text().split(BEGIN)
        PAGE.write_text(before + BEGIN + "\n".join(rows) + "\n" + END + rest.split(END)[1])


if __name__ == "__main__":
    main()
