"""The application: composes the stages, reads, simulates, scores, draws and is the command line.

pipeline, perception: scans become poses and a map. mapper is made of tracking, unguided, keyframes, pose_graph, wheels,
loop_search with loops, constellation_search and doubted_loops, session_search with sessions and relocalisation,
sonar_mapping with arc_tracking, logbook, and estimating with refining and main_map. door_tracking, wide_beam: what
the merge is told beside the views.
settings, mapper_settings: all opinions in one tree.
recordings, recording_files, readers, checkpoint, trajectory_file, pose_graph_file, room_file, decision_file,
world_file, toml_file, result_folder, exports, whole_output: what is read and written.
scores: how good it is. simulation: worlds with truth.
planning, plan_question, planner_comparison, figures, html_report, story, serve, doctor,
failures, cli, commands: what a user sees.
"""
