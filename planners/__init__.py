"""Two planners on the merged map.

World and robot: `world`, `robot`, `outline`, `poses`, `raster`. What they answer: `path`. Who checks them: `certify`.
Generalized cones, `generalized_cones`: `freeways` (facing walls, spines), `slices`, `orientations` and `circular`
(legal headings), `spine_graph`, `spine_search`, `way_in`, `entrances`, `chains`, `headings`, `lost_headings`,
`cone_outlines`, `beyond_cones` (what the cones say to another planner's path).
Configuration space, `configuration_space`: `box_space` with `cells` (labels), `subdivision` (boxes), `channels`
(search), `guide` (what leads it); `disc_space` with `visibility` (the exact roadmap); `explain` (the gap that is too
narrow).
Shared: `motion` (straight motions proved free), `shortcut`, `state_queue`, `insertion`, `compiled`.
"""
