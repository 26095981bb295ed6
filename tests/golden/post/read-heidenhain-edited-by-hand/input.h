begin pgm bracket_4711 mm
* - bracket 4711
cycl def 247 datum setting q339=+1
cycl def 32.0 tolerance
cycl def 32.1 t0.01
cycl def 32.2 hsc-mode:0 ta0.02
tool def 1
tool call 1 z s9000 f300
l x+0 y+0 fmax m3
l z+50 r0 fmax m8
l z2 fmax ; down to the face
cycl def 9.0 dwell time
cycl def 9.1 dwell 0.5
l z-1.5
cycl def 9.0 dwell time
cycl def 9.1 dwell 1.5
l x30 f1200
cc x+30 y+10
c x+40 y+10 dr+
cc x+40 y+20
c x+50 y+20 dr-
l y40
l z50 fmax m9
stop
; OPERATION rework-1
m5
l z0 fmax m91
tool call 7 z s18000 dl+0 dr+0
m3
l x-5 y-5 fmax
l z50 fmax
l z-2 fmax
l x+5 y-5 f800
cc x+5 y+0
c x+5 y-5 dr+
cp ipa+810 iz-4.5 dr+ f500
l z50 fmax
m5
l z0 r0 fmax m91
m30
end pgm bracket_4711 mm
