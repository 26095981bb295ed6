o4711 (bracket 4711)
g21 g90 g17 g40 g49 g80 g94
g54
t1 m6
s9000 m3
m8
g0 x0 y0
g43 h1 z50.
z2. (down to the face)
g4 p500
g1 z-1.5 f300
g4 x1.5
x30. f1200
g3 x40. y10. r10.
g2 x50. y20. r-10.
g1 x50. y40.
g0 z50. m9
m1
(OPERATION rework-1)
m5
g53 g0 z0
t7 m6
s18000 m3
g0 x-5. y-5.
g43 h7 z50.
z-2.
g1 x5. y-5. f800.
g3 x5. y-5. i0 j5.
g0 z50.
m5
g53 g0 z0.
m30
