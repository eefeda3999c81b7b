#pragma once

#include <boost/preprocessor/control/iif.hpp>
#include <boost/preprocessor/punctuation/is_begin_parens.hpp>
#include <boost/preprocessor/seq/for_each.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>

/// Names the fields of an options struct for what reads and writes them: the member
/// VisitFields(visit), which calls visit("NAME", NAME) for each of them. A field in parentheses is
/// an options struct itself, whose fields stand beside the others.
#define ARFM_FIELDS(...)                                                            \
  template <class Visitor>                                                          \
  void VisitFields(Visitor&& visit) {                                               \
    BOOST_PP_SEQ_FOR_EACH(ARFM_VISIT_ANY, _, BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__)) \
  }
#define ARFM_VISIT_ANY(r, data, field) \
  BOOST_PP_IIF(BOOST_PP_IS_BEGIN_PARENS(field), ARFM_VISIT_BESIDE, ARFM_VISIT_FIELD)(field)
#define ARFM_VISIT_FIELD(field) visit(#field, field);
#define ARFM_VISIT_BESIDE(field) field.VisitFields(visit);
