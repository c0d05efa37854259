# SPDX-License-Identifier: MIT
"""The table of benchmark.py: as text, and beside an earlier one."""
import math

COLUMNS = (("coverage", "{:.3f}", 1), ("segments", "{:g}", 1), ("ATE m, longest", "{:.4f}", 1),
           ("worst", "{:.4f}", 1), ("% of path", "{:.2f}", 100), ("ATE m, all", "{:.4f}", 1), ("focal px", "{:.1f}", 1),
           ("focal off %", "{:+.1f}", 100), ("error / sigma", "{:.2f}", 1), ("beyond 3 sigma, %", "{:.1f}", 100),
           ("far off, said good", "{:g}", 1), ("frames/s", "{:.0f}", 1), ("live p95 ms", "{:.1f}", 1), ("MB", "{:.0f}", 1))
KEYS = ("coverage", "segments", "ate_m", "ate_worst_m", "ate_share", "ate_all_m", "focal_px", "focal_error",
        "sigma_ratio", "beyond_3_sigma", "good_far_off", "fps", "live_p95_ms", "memory_mb")
# What is compared, and whether more of it is worse.
COMPARED = (("ate_m", True), ("ate_all_m", True), ("coverage", False), ("segments", True), ("beyond_3_sigma", True),
            ("good_far_off", True), ("fps", False), ("live_p95_ms", True), ("memory_mb", True))


def line(cells):
    return "| " + " | ".join(cells) + " |"


def cells_of(row):
    return [form.format(scale * row[key]) if key in row else "-" for (_, form, scale), key in zip(COLUMNS, KEYS)]


def table_text(table):
    """Protocol, one row a condition, and what went wrong."""
    out = [f"{name}: {value}" for name, value in table["protocol"].items()] + [""]
    heads = ["recording", "condition", *(name for name, _, _ in COLUMNS)]
    out += [line(heads), "|" + "---|" * len(heads)]
    out += [line([row["recording"], row["condition"], *cells_of(row)]) for row in table["rows"]]
    problems = [row for row in table["rows"] if "problem" in row]
    out += ["", *(f"{row['recording']} {row['condition']} failed: {row['problem']}" for row in problems)]
    return "\n".join(out).rstrip("\n") + "\n"


def comparison_text(table, earlier, worse):
    """Ratio of each figure to the earlier one, and the names of those that got worse by more than `worse`."""
    before = {(row["recording"], row["condition"]): row for row in earlier["rows"]}
    heads = ["recording", "condition", *(key for key, _ in COMPARED), "worse"]
    out = ["new over earlier:", "", line(heads), "|" + "---|" * len(heads)]
    for row in table["rows"]:
        old = before.get((row["recording"], row["condition"]))
        if old is None:
            continue
        ratios, flags = [], []
        for key, more_is_worse in COMPARED:
            if key not in old or key not in row:
                ratios.append("-")
                if key in old:
                    flags.append(f"{key} gone")
                continue
            ratio = row[key] / old[key] if old[key] else math.inf if row[key] else 1.0
            ratios.append(f"{ratio:.2f}")
            if (ratio > 1 + worse) if more_is_worse else (ratio < 1 / (1 + worse)):
                flags.append(key)
        out.append(line([row["recording"], row["condition"], *ratios, ", ".join(flags)]))
    return "\n".join(out) + "\n"
