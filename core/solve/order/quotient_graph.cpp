// SPDX-License-Identifier: MIT
// Quotient graph: elimination by minimum degree.
#include "core/solve/order/quotient_graph.hpp"

#include <algorithm>
#include <limits>

#include "core/base/check.hpp"

namespace unisim {

Span<int32_t> QuotientGraph::take(int32_t count) {
  const Span<int32_t> part = work_.subspan(taken_, count);
  taken_ += count;
  return part;
}

QuotientGraph::QuotientGraph(Span<const int32_t> adjacency_start, Span<const int32_t> adjacency,
                             int32_t first_late, Span<int32_t> work)
    : n_(adjacency_start.size() - 1), first_late_(first_late), work_(work) {
  for (Span<int32_t>* part :
       {&start_, &length_, &elements_, &weight_, &degree_, &stamp_, &head_, &next_, &previous_,
        &hash_head_, &parent_, &twin_next_, &twin_last_}) {
    *part = take(n_);
  }
  list_ = take(work.size() - taken_);
  list_end_ = adjacency.size();
  UNISIM_CHECK(list_.size() >= list_end_ + n_);
  std::copy(adjacency.begin(), adjacency.end(), list_.begin());
  head_.fill(kNone);
  hash_head_.fill(kNone);
  parent_.fill(kNone);
  twin_next_.fill(kNone);
  stamp_.fill(0);
  elements_.fill(0);
  weight_.fill(1);
  for (int32_t i = n_ - 1; i >= 0; --i) {
    start_[i] = adjacency_start[i];
    length_[i] = adjacency_start[i + 1] - adjacency_start[i];
    degree_[i] = length_[i];
    twin_last_[i] = i;
    if (!is_late(i)) push_degree(i);
  }
}

void QuotientGraph::push_degree(int32_t i) {
  const int32_t d = degree_[i];
  next_[i] = head_[d];
  previous_[i] = kNone;
  if (head_[d] != kNone) previous_[head_[d]] = i;
  head_[d] = i;
  minimum_ = std::min(minimum_, d);
}

void QuotientGraph::remove_degree(int32_t i) {
  if (next_[i] != kNone) previous_[next_[i]] = previous_[i];
  if (previous_[i] != kNone) {
    next_[previous_[i]] = next_[i];
  } else {
    head_[degree_[i]] = next_[i];
  }
}

int32_t QuotientGraph::pop_minimum() {
  while (head_[minimum_] == kNone) ++minimum_;
  const int32_t i = head_[minimum_];
  remove_degree(i);
  return i;
}

// Close the gaps between the lists when `needed` entries do not fit at the end. The first entry of
// each list is swapped with its owner's number, so one sweep finds the lists in the order they lie.
void QuotientGraph::make_room(int32_t needed) {
  if (list_end_ + needed <= list_.size()) return;
  for (int32_t i = 0; i < n_; ++i) {
    if (weight_[i] == 0 || length_[i] == 0) continue;
    const int32_t at = start_[i];
    start_[i] = list_[at];
    list_[at] = -2 - i;
  }
  int32_t to = 0;
  for (int32_t from = 0; from < list_end_;) {
    if (list_[from] >= 0) {
      ++from;
      continue;
    }
    const int32_t i = -2 - list_[from];
    list_[from] = start_[i];
    start_[i] = to;
    for (int32_t k = 0; k < length_[i]; ++k) list_[to++] = list_[from++];
  }
  list_end_ = to;
  UNISIM_CHECK(list_end_ + needed <= list_.size());
}

void QuotientGraph::absorb(int32_t e, int32_t into) {
  parent_[e] = into;
  weight_[e] = 0;
  stamp_[e] = 0;
}

// The variables next to `me` become the list of the new element; their weights turn negative as a
// mark.
int32_t QuotientGraph::gather_element(int32_t me) {
  int32_t most = length_[me] - elements_[me];
  for (int32_t k = 0; k < elements_[me]; ++k) most += length_[list_[start_[me] + k]];
  make_room(std::min(most, n_ - eliminated_));
  const int32_t begin = list_end_;
  int32_t weight = 0;
  const auto add = [&](int32_t i) {
    if (weight_[i] <= 0) return;
    weight += weight_[i];
    weight_[i] = -weight_[i];
    if (may_go(i)) remove_degree(i);
    list_[list_end_++] = i;
  };
  const int32_t own = weight_[me];
  weight_[me] = -own;  // until finish_element(), so that lists drop the pivot
  for (int32_t k = 0; k < length_[me]; ++k) {
    const int32_t member = list_[start_[me] + k];
    if (k >= elements_[me]) {
      add(member);
    } else {
      for (int32_t v = 0; v < length_[member]; ++v) add(list_[start_[member] + v]);
      absorb(member, me);
    }
  }
  start_[me] = begin;
  length_[me] = list_end_ - begin;
  elements_[me] = 0;
  degree_[me] = weight;
  return own;
}

// stamp_[e] - mark_ becomes |e \ me| for every element e that shares a variable with `me`.
void QuotientGraph::measure_elements(int32_t me) {
  for (int32_t v = 0; v < length_[me]; ++v) {
    const int32_t i = list_[start_[me] + v];
    for (int32_t k = 0; k < elements_[i]; ++k) {
      const int32_t e = list_[start_[i] + k];
      if (stamp_[e] >= mark_) {
        stamp_[e] += weight_[i];
      } else if (weight_[e] != 0) {
        stamp_[e] = degree_[e] + mark_ + weight_[i];
      }
    }
  }
}

// Rewrite the list of variable i as: me, elements that reach beyond me, variables outside me; and
// bound its degree by what they weigh. Elements inside me are absorbed.
void QuotientGraph::prune_variable(int32_t i, int32_t me, int32_t* eliminated) {
  const int32_t begin = start_[i];
  const int32_t old_elements = elements_[i];
  int32_t to = begin;
  int32_t outside = 0;
  uint32_t hash = 0;
  for (int32_t k = 0; k < old_elements; ++k) {
    const int32_t e = list_[begin + k];
    if (weight_[e] == 0) continue;
    const int32_t beyond = stamp_[e] - mark_;
    if (beyond == 0) {
      absorb(e, me);
      continue;
    }
    outside += beyond;
    list_[to++] = e;
    hash += static_cast<uint32_t>(e);
  }
  const int32_t kept = to - begin;
  for (int32_t k = old_elements; k < length_[i]; ++k) {
    const int32_t j = list_[begin + k];
    if (weight_[j] <= 0) continue;
    outside += weight_[j];
    list_[to++] = j;
    hash += static_cast<uint32_t>(j);
  }
  if (outside == 0 && may_go(i)) {  // touches nothing but me: eliminated along with it
    *eliminated -= weight_[i];
    degree_[me] += weight_[i];
    merge(i, me);
    return;
  }
  // At least one entry has gone: the pivot itself or an element it absorbed.
  UNISIM_CHECK(to < begin + length_[i]);
  list_[to] = list_[begin + kept];
  list_[begin + kept] = list_[begin];
  list_[begin] = me;
  elements_[i] = kept + 1;
  length_[i] = to - begin + 1;
  degree_[i] = std::min(degree_[i], outside);
  const int32_t bucket = static_cast<int32_t>(hash % static_cast<uint32_t>(n_));
  next_[i] = hash_head_[bucket];
  hash_head_[bucket] = i;
  previous_[i] = bucket;
}

int32_t QuotientGraph::prune_variables(int32_t me) {
  int32_t eliminated = 0;
  for (int32_t v = 0; v < length_[me]; ++v) {
    prune_variable(list_[start_[me] + v], me, &eliminated);
  }
  return eliminated;
}

// Variable or element j goes into `into`, which stands for it from now on.
void QuotientGraph::merge(int32_t j, int32_t into) {
  twin_next_[twin_last_[into]] = j;
  twin_last_[into] = twin_last_[j];
  weight_[j] = 0;
}

// Whether i, whose list is stamped with mark_, and j have the same neighbours.
bool QuotientGraph::are_twins(int32_t i, int32_t j) {
  if (length_[i] != length_[j] || elements_[i] != elements_[j]) return false;
  if (is_late(i) != is_late(j)) return false;
  for (int32_t k = 1; k < length_[j]; ++k) {  // the first entry of both is me
    if (stamp_[list_[start_[j] + k]] != mark_) return false;
  }
  return true;
}

// Variables of me with equal lists get eliminated together: keep one of each.
void QuotientGraph::merge_twins(int32_t me) {
  for (int32_t v = 0; v < length_[me]; ++v) {
    const int32_t first = list_[start_[me] + v];
    if (weight_[first] == 0) continue;
    const int32_t bucket = previous_[first];
    int32_t i = hash_head_[bucket];
    hash_head_[bucket] = kNone;
    for (; i != kNone; i = next_[i]) {
      if (next_[i] == kNone) break;
      for (int32_t k = 1; k < length_[i]; ++k) stamp_[list_[start_[i] + k]] = mark_;
      int32_t before = i;
      for (int32_t j = next_[i]; j != kNone; j = next_[j]) {
        if (are_twins(i, j)) {
          weight_[i] += weight_[j];
          merge(j, i);
          next_[before] = next_[j];
        } else {
          before = j;
        }
      }
      ++mark_;
    }
  }
}

// Drop merged variables from the list of me and put the others back among the degrees.
void QuotientGraph::finish_element(int32_t me, int32_t left) {
  int32_t to = start_[me];
  for (int32_t v = 0; v < length_[me]; ++v) {
    const int32_t i = list_[start_[me] + v];
    if (weight_[i] == 0) continue;
    weight_[i] = -weight_[i];
    degree_[i] = std::min(degree_[i] + degree_[me], left) - weight_[i];
    if (may_go(i)) push_degree(i);
    list_[to++] = i;
  }
  length_[me] = to - start_[me];
  list_end_ = to;
  weight_[me] = -weight_[me];
}

void QuotientGraph::release_late() {
  late_may_go_ = true;
  for (int32_t i = n_ - 1; i >= first_late_; --i) {
    if (weight_[i] > 0) push_degree(i);
  }
}

void QuotientGraph::eliminate_all() {
  while (eliminated_ < n_) {
    if (eliminated_ == first_late_ && !late_may_go_) release_late();
    const int32_t me = pop_minimum();
    eliminated_ += gather_element(me);
    largest_ = std::max(largest_, degree_[me]);
    if (mark_ > std::numeric_limits<int32_t>::max() - 3 * n_) {
      stamp_.fill(0);
      mark_ = 1;
    }
    measure_elements(me);
    eliminated_ += prune_variables(me);
    mark_ += largest_ + 1;
    merge_twins(me);
    finish_element(me, n_ - eliminated_);
  }
}

// Postorder of the tree of absorbed elements: what is updated together lies together.
void QuotientGraph::write_order(Span<int32_t> order) {
  const Span<int32_t> child = head_;
  const Span<int32_t> sibling = next_;
  const Span<int32_t> is_element = stamp_;
  const Span<int32_t> stack = start_;
  child.fill(kNone);
  is_element.fill(1);
  for (int32_t i = 0; i < n_; ++i) {
    if (twin_next_[i] != kNone) is_element[twin_next_[i]] = 0;
  }
  for (int32_t i = n_ - 1; i >= 0; --i) {
    if (is_element[i] == 0 || parent_[i] == kNone) continue;
    sibling[i] = child[parent_[i]];
    child[parent_[i]] = i;
  }
  int32_t written = 0;
  for (int32_t root = 0; root < n_; ++root) {
    if (is_element[root] == 0 || parent_[root] != kNone) continue;
    int32_t depth = 0;
    stack[depth++] = root;
    while (depth > 0) {
      const int32_t e = stack[depth - 1];
      const int32_t next_child = child[e];
      if (next_child != kNone) {
        child[e] = sibling[next_child];
        stack[depth++] = next_child;
        continue;
      }
      --depth;
      for (int32_t i = e; i != kNone; i = twin_next_[i]) order[written++] = i;
    }
  }
  UNISIM_CHECK(written == n_);
}

}  // namespace unisim
