"""A finished map for other programs: drawings, occupancy grids, meshes, layers, trajectories and pose graphs.

`formats` has the table and the way to write each; every other file here is one format.
"""
