"""The works that a run rests on, as BibTeX."""

ENTRIES = {
    "nezamabadi2017": """@inproceedings{nezamabadi2017,
  author    = {Nezamabadi, Saeid and Nguyen and Delenne, Jean-Yves and Averseng, Julien and Frank, Xavier and Radjai, Farhang},
  title     = {Modelling soft granular materials},
  booktitle = {Powders \\& Grains 2017},
  series    = {EPJ Web of Conferences},
  volume    = {140},
  year      = {2017}
}""",
    "moreau1988": """@incollection{moreau1988,
  author    = {Moreau, J. J.},
  title     = {Unilateral contact and dry friction in finite freedom dynamics},
  booktitle = {Nonsmooth Mechanics and Applications},
  publisher = {Springer},
  year      = {1988}
}""",
    "jean1999": """@article{jean1999,
  author  = {Jean, M.},
  title   = {The non-smooth contact dynamics method},
  journal = {Computer Methods in Applied Mechanics and Engineering},
  volume  = {177},
  pages   = {235},
  year    = {1999}
}""",
    "ogden1972": """@article{ogden1972,
  author  = {Ogden, R. W.},
  title   = {Large deformation isotropic elasticity},
  journal = {Proceedings of the Royal Society of London A},
  volume  = {326},
  pages   = {565},
  year    = {1972}
}""",
    "reese1998": """@article{reese1998,
  author  = {Reese, S. and Govindjee, S.},
  title   = {A theory of finite viscoelasticity and numerical aspects},
  journal = {International Journal of Solids and Structures},
  volume  = {35},
  pages   = {3455},
  year    = {1998}
}""",
}
SOFTWARE = """@software{{softgrain,
  author  = {{{{The softgrain developers}}}},
  title   = {{softgrain: simulation of soft granular matter}},
  version = {{{version}}},
  year    = {{{year}}},
  note    = {{commit {commit}}}
}}"""


def bibtex(facts, keys) -> str:
    """The software as it was used, then the entries named, each once."""
    software = SOFTWARE.format(version=facts.version, commit=facts.commit, year=facts.year)
    return "\n\n".join([software, *(ENTRIES[key] for key in dict.fromkeys(keys) if key != "softgrain")])
