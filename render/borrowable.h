// A list that owns its items or borrows somebody else's.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace atomesh {

// Borrowed items must outlive the list and its copies, and stay as they are. Both kinds are read the same way; writing
// first makes borrowed items the list's own.
template <class T>
class Borrowable {
 public:
  Borrowable() = default;
  Borrowable(std::vector<T> items) : own_(std::move(items)) {}
  static Borrowable borrow(std::span<const T> items) {
    Borrowable list;
    list.borrowed_ = items;
    return list;
  }

  bool borrows() const { return !borrowed_.empty(); }
  std::size_t size() const { return borrows() ? borrowed_.size() : own_.size(); }
  bool empty() const { return size() == 0; }
  const T* data() const { return borrows() ? borrowed_.data() : own_.data(); }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size(); }
  const T& operator[](std::size_t i) const { return data()[i]; }
  const T& front() const { return *data(); }

  // To be written to.
  std::vector<T>& own() {
    if (borrows()) {
      own_.assign(begin(), end());
      borrowed_ = {};
    }
    return own_;
  }
  void push_back(const T& item) { own().push_back(item); }
  void clear() {
    borrowed_ = {};
    own_.clear();
  }

  friend bool operator==(const Borrowable& a, const Borrowable& b) { return std::ranges::equal(a, b); }

 private:
  std::vector<T> own_;           // empty where borrowed
  std::span<const T> borrowed_;  // empty where own
};

}  // namespace atomesh
