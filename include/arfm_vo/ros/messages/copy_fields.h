#pragma once

#include <boost/preprocessor/seq/for_each.hpp>
#include <boost/preprocessor/tuple/elem.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>

/// Gives `to` the named fields of `from`, which both have by the same name.
#define ARFM_COPY_FIELDS(to, from, ...) \
  BOOST_PP_SEQ_FOR_EACH(ARFM_COPY_FIELD, (to, from), BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__))
#define ARFM_COPY_FIELD(r, pair, field) \
  BOOST_PP_TUPLE_ELEM(0, pair).field = BOOST_PP_TUPLE_ELEM(1, pair).field;
