"""How the sensors of the paper, and their successors, answer a world of surfaces.

`surfaces`, `rays`: what there is to meet. `transducer`, `echoes`, `sonar`: sound. `infrared`, `lidar`,
`time_of_flight`: light.
"""
