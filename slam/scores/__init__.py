"""How good a result is: `results` scores a folder, by `trajectories`, `maps` and their `boundaries` and `objects`."""
