"""Alignments in, poses out; placed views in, one room map out.

Poses: `odometry`, `steady_motion`, `loop_closure`, `landmark_map`, `factor_graph`, `joint_refinement`, `face_cells`,
`long_faces`, `reduced_equations`, `estimate`.
What a view says: `view`, `half_steps`, `surfaces`, `samples`, `ballots`, `sight`.
Poses of a sonar: `arcs`, `arc_association`, `arc_births`, `arc_landmarks`, `doubled_landmarks`, `square_walls`,
`wheel_noise`.
Views pulled together: `settling`, `shared_lines`, `wall_directions`, `settled_poses`.
Merging: `polygon_merging` (the verb), `cell_lines`, `wall_faces`, `snapping`, `evidence`, `far_ground`, `grazing`,
`contours`.
The map: `room_map` (the noun), `map_reading`, `provenance`, `along_edges`, `leak_repair`, `leak_alarm`, `seen_through`,
`hidden_objects`, `occluders`, `doors`, `door_walls`, `decisions`.
From the map on: `next_view`, `thin_rectangles`.
"""
