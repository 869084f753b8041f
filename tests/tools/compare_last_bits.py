#!/usr/bin/python3
"""compare_last_bits.py FILE.json: by the report of `razor compare`, two pictures show the same but for last bits.

At most one pixel of 1000 differs. What was seen there (depths, normals, albedos) is off by roundings; light may be off by
more, as the shadow rays that leave from there may be decided otherwise. Exits with 1 if not.
"""
import json
import sys

MOST_PIXELS = 1e-3
MOST_DIFFERENCE = 1e-5
LIGHT = {"R", "G", "B"}


def complaints(report):
    share = report["pixels_differing"] / (report["width"] * report["height"])
    if share > MOST_PIXELS:
        yield f"{report['pixels_differing']} pixels differ, {share:.2%} of all"
    for channel in report["channels"]:
        if channel["not_finite_pixels_differing"] > 0:
            yield f"{channel['name']}: {channel['not_finite_pixels_differing']} pixels are numbers in one picture only"
        if channel["name"] not in LIGHT and channel["largest_difference"] > MOST_DIFFERENCE:
            yield f"{channel['name']}: differs by up to {channel['largest_difference']:g} at {channel['largest_at']}"
    for where in ("picture", "reference"):
        if report[f"only_in_{where}"]:
            yield f"only in the {where}: {' '.join(report[f'only_in_{where}'])}"


def main():
    if len(sys.argv) != 2:
        sys.exit("compare_last_bits.py: give the report of a comparison: compare_last_bits.py FILE.json")
    report = json.load(open(sys.argv[1]))
    found = list(complaints(report))
    for line in found:
        print(line)
    print(f"{report['pixels_differing']} of {report['width']} x {report['height']} pixels differ")
    sys.exit(1 if found else 0)


main()
