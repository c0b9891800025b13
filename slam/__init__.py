"""The application: composes the stages, reads, simulates, scores, draws and is the command line.

pipeline, perception, mapper and its parts tracking, wheels, pose_graph, loop_search, session_search, sonar_mapping and
estimating: scans become poses and a map. settings: all opinions in one tree.
recordings, readers, trajectory_file, room_file, toml_file, result_folder, whole_output: what is read and written.
scoring, map_scores, boundary_scores, object_scores, trajectory_scores: how good it is. simulation: worlds with truth.
planning, figures, story, doctor, failures, cli: what a user sees.
"""
