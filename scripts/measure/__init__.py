"""What scripts/bench, scripts/quality and some checks measure with: captures, pictures and their distances in numpy, none of it
this project's C++, and the pages of docs/ that hold the figures."""
