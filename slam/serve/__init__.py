"""The web view: a map that grows in the browser while scans stream in, and both planners on it.

`server` opens the door, `application` has the routes, `guard` decides who may knock. A `Run` keeps what the page shows;
its messages (`messages`) come out of a process of its own (`worker`) that merges or replays (`growth`, `replay`).
The page itself lies in `page/`: plain HTML, CSS and JavaScript modules, no build step and nothing from elsewhere.
"""
