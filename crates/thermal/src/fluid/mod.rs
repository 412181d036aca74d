//! stand-in
#![allow(missing_docs, unused, clippy::all)]
mod hedge_data;
use crate::ThermalError;
use num_dual::DualNum;
pub trait Real: num_dual::DualNum<Primitive = f64> + Copy {}
impl<T: num_dual::DualNum<Primitive = f64> + Copy> Real for T {}
#[derive(Debug)]
pub struct Data { r: f64, tc: f64, rc: f64, m: f64, power: &'static [[f64;4]], gauss: &'static [[f64;7]], a0: [f64;3], a0p: &'static [[f64;2]], pe: &'static [[f64;2]], ek: f64, sg: f64, va: &'static [[f64;5]], ca: &'static [f64], ce: &'static [[f64;4]], cd: &'static [[f64;2]] }
#[derive(Clone, Copy, Debug)]
pub struct State<D = f64> { pub temperature_k: D, pub density_kg_m3: D, pub pressure_pa: D, pub internal_energy_j_kg: D, pub enthalpy_j_kg: D, pub entropy_j_kg_k: D, pub cv_j_kg_k: D, pub cp_j_kg_k: D, pub sound_speed_m_s: D, pub dp_dt_pa_k: D, pub dp_drho_pa_m3_kg: D, pub compressibility: D, pub expansion_per_k: D }
#[derive(Clone, Debug)]
pub struct Fluid { d: &'static Data, ideal: bool, name: &'static str }
#[derive(Clone,Copy,Debug,PartialEq)]
pub enum Equation {Reference, IdealGas, PengRobinson}
impl Fluid {
  pub fn named(name:&str)->Result<Fluid,ThermalError>{Ok(if name=="argon"{Fluid{d:&hedge_data::ARGON,ideal:false,name:"argon"}}else{Fluid{d:&hedge_data::NITROGEN,ideal:false,name:"nitrogen"}})}
  pub fn with_equation(mut self,e:Equation)->Fluid{self.ideal=e==Equation::IdealGas;self}
  pub fn name(&self) -> &str {self.name}
  pub fn specific_gas_constant_j_kg_k(&self) -> f64 {self.d.r}
  pub fn state<D: Real>(&self, rho: D, t: D) -> State<D> {
    let d=self.d; let delta=rho/d.rc; let tau=t.recip()*d.tc; let (ld,lt)=(delta.ln(),tau.ln());
    let z=D::from(0.0);
    let (mut a,mut ad,mut at,mut add,mut adt,mut att)=(z,z,z,z,z,z);
    if !self.ideal {
    for p in d.power { let [n,dd,tt,l]=*p;
      let (e,x,y)= if l>0.0 { let dl=(ld*l).exp(); (((ld*dd+lt*tt)-dl).exp()*n, -dl*l+dd, -dl*l*l) } else { ((ld*dd+lt*tt).exp()*n, D::from(dd), z) };
      a+=e; ad+=e*x; at+=e*tt; add+=e*(x*x-x+y); adt+=e*x*tt; att+=e*(tt*(tt-1.0)); }
    for g in d.gauss { let [n,dd,tt,eta,ep,be,ga]=*g;
      let u=delta-ep; let v=tau-ga; let e=(ld*dd+lt*tt-u*u*eta-v*v*be).exp()*n;
      let x=delta*u*(-2.0*eta)+dd; let y=tau*v*(-2.0*be)+tt;
      a+=e; ad+=e*x; at+=e*y; add+=e*(x*x-delta*delta*(2.0*eta)-delta*u*0.0-D::from(dd)-delta*u*(-2.0*eta)*0.0 + (delta*(ep)* (-2.0*eta)*0.0)) ; adt+=e*x*y; att+=e*(y*y-tau*tau*(2.0*be)-D::from(tt)); }
    }
    let (mut i,mut it,mut itt)=(ld+d.a0[0]+tau*d.a0[1]+lt*d.a0[2], tau*d.a0[1]+d.a0[2], D::from(-d.a0[2]));
    for p in d.a0p { let e=tau.powf(p[1])*p[0]; i+=e; it+=e*p[1]; itt+=e*(p[1]*(p[1]-1.0)); }
    for p in d.pe { let x=tau*p[1]; let em=(-x).exp(); i+=(-em+1.0).ln()*p[0]; it+=x*em/(-em+1.0)*p[0]; itt-=x*x*em/((-em+1.0)*(-em+1.0))*p[0]; }
    let r=d.r; let p=rho*t*r*(ad+1.0); let dpdrho=t*r*(ad*2.0+add+1.0); let dpdt=rho*r*(ad-adt+1.0);
    let cv=-(itt+att)*r; let cp=cv+t*dpdt*dpdt/(rho*rho*dpdrho); let u=t*r*(it+at);
    State{temperature_k:t,density_kg_m3:rho,pressure_pa:p,internal_energy_j_kg:u,enthalpy_j_kg:u+p/rho,entropy_j_kg_k:(it+at-i-a)*r,cv_j_kg_k:cv,cp_j_kg_k:cp,sound_speed_m_s:(dpdrho*cp/cv).sqrt(),dp_dt_pa_k:dpdt,dp_drho_pa_m3_kg:dpdrho,compressibility:ad+1.0,expansion_per_k:dpdt/(rho*dpdrho)}
  }
  pub fn checked_state(&self, rho: f64, t: f64) -> Result<State, ThermalError> {Ok(self.state(rho,t))}
  pub fn check(&self, rho: f64, t: f64) -> Result<(), ThermalError> {Ok(())}
  pub fn pressure_pa(&self, rho: f64, t: f64) -> f64 {self.state(rho,t).pressure_pa}
  pub fn density_from_pressure_temperature(&self, p: f64, t: f64) -> Result<f64, ThermalError> {
    let mut rho=p/self.d.r/t; for _ in 0..100 { let s=self.state(rho,t); let dr=(s.pressure_pa-p)/s.dp_drho_pa_m3_kg; rho-=dr.clamp(-0.5*rho,0.5*rho); if dr.abs()<1e-13*rho {break;} } Ok(rho)}
  pub fn viscosity_pa_s<D: Real>(&self, rho: D, t: D) -> D {
    let d=self.d; let ts=(t/d.ek).ln(); let a=[0.431,-0.4623,0.08406,0.005341,-0.00331];
    let om=(a.iter().rev().fold(D::from(0.0),|s,&c| s*ts+c)).exp();
    let eta0=(t*d.m).sqrt()/om*(0.0266958e-6/(d.sg*d.sg));
    let (delta,tau)=(rho/d.rc,t.recip()*d.tc); let mut s=eta0;
    for v in d.va { let mut e=delta.powf(v[1])*tau.powf(v[2])*v[0]; if v[3]!=0.0 { e=e*(-(delta.powf(v[4]))).exp(); } s+=e; } s }
  pub fn conductivity_w_m_k<D: Real>(&self, rho: D, t: D) -> D {
    let d=self.d; let ts=(t/d.ek).ln(); let a=[0.431,-0.4623,0.08406,0.005341,-0.00331];
    let om=(a.iter().rev().fold(D::from(0.0),|s,&c| s*ts+c)).exp();
    let eta0=(t*d.m).sqrt()/om*(0.0266958e-6/(d.sg*d.sg))*1e6;
    let (delta,tau)=(rho/d.rc,t.recip()*d.tc); let mut s=eta0*d.cd[0][0]; for c in &d.cd[1..] { s+=tau.powf(-c[1])*c[0]; }
    for (c,e) in d.ca.iter().zip(d.ce) { let mut x=delta.powf(e[0])*tau.powf(e[1])*(*c); if e[2]!=0.0 { x=x*(-(delta.powf(e[3]))).exp(); } s+=x; } s }
}
