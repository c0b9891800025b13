"""Readers of recordings: carmen, ranges_csv, recording_folder, wheel_ticks, crazyflie; each path -> Recording.

sieve passes lines and keeps what is damaged; latency finds a scanner's lag; range_table is the shared CSV.
"""
