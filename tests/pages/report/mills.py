"""Mills and vessels whose reports a browser shows: every motion and shape, large and tiny, with
many, few and no impacts."""
SPEX = 'type = "spex8000"'
STILL = 'type = "still"'
CYLINDER = 'diameter = "38 mm"\nheight = "57 mm"'
TEN = '[[balls]]\ncount = 10\ndiameter = "5 mm"'
HITS = "[contact]\nrestitution = 0.5\nfriction = 0.4"
SKEW = """type = "chain"
[[mill.joint]]
rotate = [1, 2, 2]
speed = "7 rad/s"
[[mill.joint]]
translate = ["30 mm", "-5 mm", 0]
[[mill.joint]]
rotate = "z"
angle = "20 deg"
swing = [{amplitude = "15 deg", speed = "700 rpm"}]
[[mill.joint]]
rotate = "x"
speed = "-90 rpm\""""
SLIDING = """type = "chain"
[[mill.joint]]
translate = [1, -2, 2]
speed = "3 m/s"
[[mill.joint]]
rotate = "z"
speed = "-90 rpm\""""
PRISM = """type = "polyhedron"
vertex = [{at = ["30 mm", "-25 mm", 0]}, {at = ["-18 mm", "-25 mm", "27 mm"]}, {at = ["-18 mm", "-25 mm", "-27 mm"]},
  {at = ["36 mm", "25 mm", 0]}, {at = ["-21 mm", "25 mm", "32 mm"]}, {at = ["-21 mm", "25 mm", "-32 mm"]}]"""
ROUNDED = 'type = "rounded_cylinder"\ndiameter = "38 mm"\nheight = "57 mm"\nedge_radius = "%s"'
AT_REST = '[[ball]]\ndiameter = "5 mm"\nposition = [0, 0, 0]'
HALF = 'end_time = "0.5 s"\ngravity = "9.8 m/s2"'


def mill(motion=SPEX, vessel=CYLINDER, balls=TEN, run=HALF, contact=HITS):
    return f"[run]\n{run}\n[mill]\n{motion}\n[vessel]\n{vessel}\n{contact}\n{balls}\n"


MILLS = {
    "planetary": mill('type = "planetary"\nradius = "75 mm"\nspeed = "300 rpm"\nratio = -2',
                      ROUNDED % "8 mm"),
    "wide_planetary": mill('type = "planetary"\nradius = "1 m"\nspeed = "60 rpm"\nratio = -3',
                           run='end_time = "1.2 s"'),
    "vibratory_box": mill(
        'type = "vibratory"\namplitude = ["3 mm", "11 mm", "-2 mm"]\nspeed = "900 cpm"',
        'type = "box"\nsize = ["33 mm", "57 mm", "36 mm"]'), "large_drum": mill(
            'type = "drum"\nspeed = "15 rpm"', 'diameter = "4 m"\nheight = "2 m"',
            '[[balls]]\ncount = 10\ndiameter = "30 cm"\ngap_wall = "1 cm"',
            'end_time = "9 s"\ngravity = "9.8 m/s2"'), "tiny_sphere": mill(
                'type = "vibratory"\namplitude = [0, "0.1 mm", 0]\nspeed = "1 kHz"'.replace(
                    "1 kHz", "1000 Hz"), 'type = "sphere"\ndiameter = "0.4 mm"',
                '[[balls]]\ncount = 5\ndiameter = "40 um"\ngap_ball = "1 um"\ngap_wall = "1 um"',
                'end_time = "0.05 s"'),
    "skew_chain_capsule": mill(SKEW, 'type = "capsule"\ndiameter = "38 mm"\nheight = "57 mm"'),
    "sliding_chain": mill(SLIDING), "prism": mill(vessel=PRISM),
    "capsule_that_is_a_sphere": mill(vessel='type = "capsule"\ndiameter = "38 mm"\nheight = "38 mm"'
                                    ), "all_of_it_edge": mill(vessel=ROUNDED % "19 mm"),
    "lens": mill(
        vessel=
        'type = "rounded_cylinder"\ndiameter = "57 mm"\nheight = "38 mm"\nedge_radius = "19 mm"'
    ), "piston": mill(vessel=CYLINDER + '\n[[vessel.piston]]\nwall = "cap +y"\ndistance = "6 mm"\n'
                      'swing = [{amplitude = "5 mm", speed = "2500 rpm"}]'
                     ), "no_dose": mill(contact="[contact]\nrestitution = 1\nfriction = 0"
                                       ), "no_impacts": mill(STILL, balls=AT_REST,
                                                             run='end_time = "1 s"'),
    "one_impact": mill(STILL, balls=AT_REST + '\nvelocity = ["0.02 m/s", 0, 0]',
                       run='end_time = "0.9 s"'),
    "late": mill(run='initial_time = "1000000 s"\nend_time = "1000000.5 s"'),
    "fast": mill('type = "vibratory"\namplitude = [0, "1 mm", 0]\nspeed = "20000 Hz"',
                 run='end_time = "0.0004 s"'), "many_partners": mill(
                     run=HALF + '\nstart_time = "0.49 s"',
                     vessel='type = "box"\nsize = ["33 mm", "57 mm", "36 mm"]'),
}
# Those that are shown in every run of the tests; the others take a minute more.
SOME = ("planetary", "large_drum", "tiny_sphere", "prism", "lens", "no_impacts")
WITHOUT_DOSE = ("no_dose", "no_impacts", "one_impact")
