"""One scan in, a primal sketch out; two sketches in, an alignment out.

scan           what the head saw in one turn, with the facts of its sensor
sensors/       what sonar, infrared, lidar and time-of-flight would read in a given world
fusion         sonar and infrared combined by three rules: opening undoes the beam, redrawing opens the doors
mirrors        smooth walls, heard from their feet alone; past them nothing is known beyond their lines
room_corners   square corners the beam cannot see into, inferred; half_beam tells how wide it is
range_arcs     what a region of constant depth says of the wall behind it
door_edges     jambs tracked over scans
contour        readings joined into a boundary, every edge real or a line of sight; surface for registration
scale_space    the boundary's orientation at several scales; landmarks and jambs are what stands out
primal_sketch  knots, fitted lines and the polyline between them; best_polylines draws a scan with few vertices
matching       knots of two sketches paired: near by joint compatibility, lost by constellations;
               corner_constellations lays corners of a newest submap on those of an old map
registration   real surface laid on real surface; rigid_motion is the algebra of poses
"""
