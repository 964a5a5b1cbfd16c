"""A scene that needs a second: an elastic bed on a floor with a door, whose upper half is dug out."""

CASE = """
kind = "scene"
title = "tiny"
material = "linear_elastic"
packing = {grains = 60, pressure = "10 kPa"}
elastic = {modulus = "50 MPa", poisson = 0.3}
gravity = {uniform_step = 0.5, ratio = 3}
support = [
  {boundary = "floor", fix = "xy"}, {boundary = "door", fix = "y"}, {boundary = ["left", "right"], fix = "x"}
]
region = [{name = "sand"}, {name = "cut"}]
record = [
  {name = "middle", point = ["1 m", "1 m"]},
  {name = "level", line = [["0 m", "0.9 m"], ["2 m", "0.9 m"]], points = 9},
  {name = "wall", line = [["2 m", "0 m"], ["2 m", "1 m"]], points = 5},
  {name = "bed", region = "sand"},
]

[mesh]
shape = "grid"
x = ["0 m", "1 m", "2 m"]
columns = [2, 2]
y = ["0 m", "1 m", "2 m"]
rows = [2, 2]
base = ["floor", "door"]
layers = ["sand", "cut"]

[[stage]]
name = "weight"
gravity = 1
[[stage]]
name = "dig"
steps = 1
excavate = [{region = "cut"}]
[[stage]]
name = "lower"
steps = 4
move = [{boundary = "door", y = "-4 mm"}]
[[stage]]
name = "free"
steps = 2
release = [{boundary = "door", share = "50 %"}]
"""
