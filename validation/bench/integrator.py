"""Direct light by a sampling strategy, for llvm_ad_rgb: the variant must be set before this is imported."""

import drjit as dr
import mitsuba as mi


class Direct(mi.SamplingIntegrator):
    """Direct light by the emitter's directions and, `strategy` = `bsdf` or `cosine`, by the BSDF's or a cosine's as well,
    joined by the balance heuristic; everything else is the same."""

    def __init__(self, properties):
        super().__init__(properties)
        self.strategy = properties.get("strategy", "bsdf")

    def sample(self, scene, sampler, ray, medium=None, active=True):
        """Light along rays."""
        context, cosine = mi.BSDFContext(), self.strategy == "cosine"
        si = scene.ray_intersect(ray, active)
        light = dr.select(si.is_valid(), 0.0, si.emitter(scene).eval(si, active))
        active = active & si.is_valid()
        bsdf = si.bsdf(ray)
        ds, weight = scene.sample_emitter_direction(si, sampler.next_2d(active), True, active)
        wo = si.to_local(ds.d)
        value, pdf = bsdf.eval_pdf(context, si, wo, active)
        if cosine:
            pdf = mi.warp.square_to_cosine_hemisphere_pdf(wo)
        share = 1.0 if self.strategy == "emitter" else dr.select(ds.delta, 1.0, ds.pdf / (ds.pdf + pdf))
        light += dr.select(active & (ds.pdf > 0), value * weight * share, 0.0)
        if self.strategy != "emitter":
            u1, u2 = sampler.next_1d(active), sampler.next_2d(active)
            if cosine:
                wo = mi.warp.square_to_cosine_hemisphere(u2)
                pdf = mi.warp.square_to_cosine_hemisphere_pdf(wo)
                weight = bsdf.eval(context, si, wo, active) / pdf
            else:
                drawn, weight = bsdf.sample(context, si, u1, u2, active)
                wo, pdf = drawn.wo, drawn.pdf
            active &= pdf > 0
            there = scene.ray_intersect(si.spawn_ray(si.to_world(wo)), active)
            ds = mi.DirectionSample3f(scene, there, si)
            other = scene.pdf_emitter_direction(si, ds, active)
            light += dr.select(active, weight * there.emitter(scene).eval(there, active) * pdf / (pdf + other), 0.0)
        return light, True, []
