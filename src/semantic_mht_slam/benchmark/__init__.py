"""The benchmark: runs slam_offline on many cases, has `evaluate` score the results, and reports on them."""
