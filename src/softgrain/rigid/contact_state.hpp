#pragma once
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// Declares the impulses of contacts that carry one, with their bodies: the order of a list depends on the
/// friction of its contacts, which a run that goes on may change. Raises IoError for contacts that the list
/// does not have.
template <int Dim>
void visit_impulses(RigidContacts<Dim>& contacts, StateVisitor& visit);

}  // namespace softgrain
