// SPDX-License-Identifier: Apache-2.0
// Domains with one fault of each kind.
#pragma once

namespace weft::files {

// Of those that a .poly file can have.
inline constexpr char kFaultyYard[] = R"(36 2 0 0
1 0 0
2 40 0
3 40 40
4 0 40
5 0 0.01
6 35 35
7 5 5
8 10 10
9 10 5
10 5 10
11 20 0
12 18 3
13 22 3
14 28 5
15 34 5
16 31 8
17 31 5
18 37 5
19 34 2
20 28 15
21 34 15
22 34 20
23 28 20
24 34.0001 20.0001
25 37 22
26 37 20.5
27 10 0.0002
28 12 3
29 8 3
30 5 20
31 15 20
32 15 20.1
33 5 30
34 10 30
35 10 35
36 5 30
37 0
1 1 2
2 2 3
3 3 4
4 4 5
5 3 6
6 7 8
7 8 9
8 9 10
9 10 7
10 11 12
11 12 13
12 13 11
13 14 15
14 15 16
15 16 14
16 17 18
17 18 19
18 19 17
19 20 21
20 21 22
21 22 23
22 23 20
23 21 20
24 24 25
25 25 26
26 26 24
27 27 28
28 28 29
29 29 27
30 30 31
31 31 32
32 32 30
33 33 34
34 34 35
35 35 36
36 6 6
37 30 32
3
1 45 20
2 30 17
3 31 18
1
1 30 15 1
)";

// Of polygons and lines, with a ring that is left out.
inline constexpr char kFaultySite[] = R"({"type": "FeatureCollection", "features": [
 {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
  [[[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]], [[3, 3], [3, 3], [4, 4], [3, 3]]]}},
 {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
  [[[8, 2], [14, 2], [14, 6], [8, 6], [8, 2]]]}},
 {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
  [[[20, 0], [24, 4], [24, 0], [20, 4], [20, 0]]]}},
 {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
  [[[0, 20], [10, 20], [10, 20.001], [0, 20.001], [0, 20]]]}},
 {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates":
  [[5, 5], [5, 15]]}}]})";

}  // namespace weft::files
