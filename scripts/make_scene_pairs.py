#!/usr/bin/python3
"""Pairs of frames for score_scenes by the protocol of Li et al., SSC: Semantic Scan Context (IROS 2021).

  make_scene_pairs.py DATASET OUTPUT_CSV [--every N] [--negatives N] [--seed N]

Positives: every N-th pair of DATASET/loop_pairs.csv (less than 3 m apart). Negatives: for each of them, frames drawn at
random that are more than 20 m from its first frame in the ground plane of DATASET/poses.txt. Defaults: 4, 100, 1.
"""
import argparse
import math
import random
from pathlib import Path

MIN_NEGATIVE_M = 20.0

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("dataset", type=Path)
parser.add_argument("output", type=Path)
parser.add_argument("--every", type=int, default=4)
parser.add_argument("--negatives", type=int, default=100)
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()

positions = []  # x right, z forward
for line in (arguments.dataset / "poses.txt").read_text().splitlines():
    row = [float(word) for word in line.split()]
    positions.append((row[3], row[11]))
lines = (arguments.dataset / "loop_pairs.csv").read_text().splitlines()
positives = [tuple(map(int, line.split(",")[:2])) for line in lines if line[:1].isdigit()][::arguments.every]
generator = random.Random(arguments.seed)
with arguments.output.open("w") as output:
    output.write("i,j\n")
    for i, j in positives:
        output.write(f"{i},{j}\n")
        far = [k for k, position in enumerate(positions) if math.dist(positions[i], position) > MIN_NEGATIVE_M]
        for k in generator.choices(far, k=arguments.negatives if far else 0):
            output.write(f"{i},{k}\n")
