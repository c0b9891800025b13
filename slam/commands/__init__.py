"""The commands of `roomsketch`, one file each; only these and `slam.cli` print or end with an exit code."""
