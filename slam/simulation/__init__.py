"""Recordings made in floor plans.

`world`: a plan read into free space and surfaces. `trajectory`: true poses and what the wheels make of them.
`record`: the drive, and the files it leaves. `plans`: the plans of the shipped recordings.
"""
