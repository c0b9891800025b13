"""Figures: what a drive saw, what the merge made of it, and what was planned; matplotlib stays in this folder.

`gallery` draws them all; `views` (scans and sketches), `rooms` (maps), `sensing` (one scan in detail) and `plans` draw
one kind each, on the `sheet` that they share.
"""
