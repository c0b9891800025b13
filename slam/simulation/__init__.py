"""Recordings made in floor plans.

`floors`, `scenes`, `buildings`, `plans`: plans that are drawn; `random_plans`: by chance; `mlstruct`: from real floors.
`world`: a plan read into free space and surfaces. `trajectory`: true poses and what the wheels make of them.
`record`: the drive through it; `truth`: what the map may be scored against.
"""
