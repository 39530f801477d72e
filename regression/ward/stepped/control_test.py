#!/usr/bin/env python3
"""stepped_mill with exact search and edmill's least separation speed gives the statistics of
edmill; with lossless impacts within 0.5 ms it does not.

usage: control_test.py STEPPED_MILL
"""
import math
import pathlib
import sys

WARD = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(WARD))
import emulation
import fixture_statistics
import intervals
import tables

wanted = fixture_statistics.wanted_rows(WARD.parents[1])
failures = 0
for name in ("5g_5_9_52mm", "5g_2_5_4_76mm"):
    case = next(case for case in tables.cases() if case.name == name)
    mean, half = (
        float(wanted[name][key]) for key in ("milling_dose_rate", "milling_dose_rate_ci95"))
    for options, agrees in ((emulation.CONTROL, True), ("--search exact --smooth-time 5e-4",
                                                        False)):
        batch = emulation.NINE_PERIODS
        doses, _ = emulation.stepped(sys.argv[1], case,
                                     f"{options} --batch {batch} --end {1 + 8 * batch}")
        rates = [dose / batch for dose in doses]
        found, limit = sum(rates) / len(rates), fixture_statistics.ALLOWED * math.hypot(
            half, intervals.half_width(rates))
        print(
            f"{name} {options}: dose rate {found:.3f} W, edmill {mean:.3f} W, allowed ±{limit:.3f}")
        failures += (abs(found - mean) <= limit) != agrees
sys.exit(failures > 0)
