#!/usr/bin/env python3
"""intervals.py against printed tables: Abramowitz and Stegun, tables 26.10 (Student) and 26.9
(Fisher, 5 %)."""
import random

import intervals

STUDENT = {1: 12.706, 2: 4.303, 4: 2.776, 10: 2.228, 30: 2.042, 120: 1.980}  # two-sided 5 %
FISHER = {(2, 10): 4.10, (4, 295): 2.40, (5, 5): 5.05,
          (1, 60): 4.00}  # upper 5 %; 295 between 120 (2.45) and infinity (2.37)

for freedom, t in STUDENT.items():
    assert abs(intervals.student95(freedom) - t) < 6e-4, (freedom, intervals.student95(freedom))
for (one, two), ratio in FISHER.items():
    found = intervals.fisher_probability(ratio, one, two)
    assert abs(found - 0.05) < 1e-3, (one, two, found)

# When batches are not correlated, the interval holds the mean in about 95 % of trials (a little
# more: the wider of two is taken), and replicas look alike in 95 %. Replicas of different means do
# not.
random.seed(20110101)
print("seed 20110101")
held = alike = found = 0
for _ in range(200):
    replicas = [[random.gauss(1, 0.1) for _ in range(20)] for _ in range(4)]
    mean, half, probability = intervals.estimate(replicas)
    held += abs(mean - 1) < half
    alike += probability > 0.05
    found += intervals.estimate(
        [[x + 0.1 * k for x in batches] for k, batches in enumerate(replicas)])[2] < 0.05
print(
    f"of 200 trials {held} intervals hold the mean, {alike} replicas look alike, {found} different ones are found"
)
assert 184 <= held <= 199 and 180 <= alike <= 198 and found >= 195
