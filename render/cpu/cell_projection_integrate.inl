// The integrators by name. Included by the kernels' sources after cell_projection_mapped.inl.

namespace atomesh::ATOMESH_ISA {

template <class Type>
struct TypeOf {
  using type = Type;
};

// visit(TypeOf<I>{}) with the integrator class I that the optics ask for. All are of one shape:
//   I(view, optics, block, pixels)
//   record(n)                        what it reads of the tile's cell n
//   compose(n, u_in, u_out, light)   lays the segment of cell n, u_in < u_out, behind what is in `light`; lanes with
//                                    u_in == u_out, or through which no light comes, keep theirs
// or, where `prepares` is true, instead of compose() its two steps:
//   prepare(n, u_in, u_out, p)       fills a Prepared with what does not depend on the light
//   lay(n, p, light)                 lays it
template <class Visit>
static inline auto with_integrator(const CellOptics& optics, Visit visit) {
  if (optics.map == nullptr) {
    switch (optics.integrator) {
      case Integrator::preintegrated:
        return visit(TypeOf<ColorIntegrator<Preintegrated>>{});
      case Integrator::sampled:
        return visit(TypeOf<ColorIntegrator<Samples>>{});
      default:
        return visit(TypeOf<ColorIntegrator<ClosedForm>>{});
    }
  }
  switch (optics.integrator) {
    case Integrator::linear:
      return visit(TypeOf<MappedEndsIntegrator<ClosedForm>>{});
    case Integrator::preintegrated:
      return visit(TypeOf<MappedEndsIntegrator<Preintegrated>>{});
    case Integrator::sampled:
      return visit(TypeOf<MappedSamplesIntegrator>{});
    default:
      return visit(TypeOf<MappedIntegrator>{});
  }
}

}  // namespace atomesh::ATOMESH_ISA
