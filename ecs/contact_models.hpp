#pragma once

// The list of contact models, in the order in which they are offered: a name in code, of which the
// enumerator is k<Name> and the law k<Name>Law, and the name that scenes, the command line and
// reports write. docs/adding_a_contact_model.md
#define TORSION_CONTACT_MODELS(MODEL) \
  MODEL(Paper, "paper")               \
  MODEL(Mdr, "mdr")                   \
  MODEL(Patch, "patch")               \
  MODEL(Winkler, "winkler")
